//! What odometry that is absurd, missing, slipping, slow or late makes of a drive, and scans that take time: in a room of 12 by 8 m, with a laser at 10 Hz.

use approx::abs_diff_eq;
use std::f64::consts::TAU;
use wayfix_slam_system::{
    points::{self, PointSlamParams, RobotProfile},
    walls::{self, WallRun, WallSlamParams},
};

use wayfix_estimation_traits::{LieGroup, Pose2};
use wayfix_sensor_log::{Detection, DetectionTarget, LaserScan, Record, RecordData, Stamp, Velocity};

/// Well above what walls leave open, and far below what each fault makes of odometry alone.
const CENTIMETRES: f64 = 0.05;
/// 95 % of χ² with three degrees of freedom.
const CONSISTENT: f64 = 7.81;

fn at(seconds: f64, data: RecordData) -> Record {
    Record { stamp: Stamp::from_seconds(seconds).expect("a time"), data }
}

/// A robot that goes round an oval and turns unevenly.
fn pose(step: usize) -> Pose2<f64> {
    pose_after(step as f64)
}

/// The same between two steps.
fn pose_after(steps: f64) -> Pose2<f64> {
    let phase = steps * 0.02;
    let angle = phase + 0.3 * (3.0 * phase).sin();
    Pose2::new(3.0 * angle.cos(), 2.0 * angle.sin(), angle + TAU / 4.0)
}

/// The range to the walls of the room, and to a pillar that takes the symmetry away.
fn range(pose: &Pose2<f64>, bearing: f64) -> f64 {
    let (sin, cos) = (pose.heading() + bearing).sin_cos();
    let wall = |origin: f64, direction: f64, half: f64| {
        if direction == 0.0 { f64::INFINITY } else { (half * direction.signum() - origin) / direction }
    };
    let room = wall(pose.x(), cos, 6.0).min(wall(pose.y(), sin, 4.0));
    let [low, high] = [(-0.6, -0.4), (0.5, 0.3)];
    let slab = |origin: f64, direction: f64, low: f64, high: f64| {
        let (a, b) = ((low - origin) / direction, (high - origin) / direction);
        (a.min(b), a.max(b))
    };
    let (x, y) = (slab(pose.x(), cos, low.0, high.0), slab(pose.y(), sin, low.1, high.1));
    let (enter, leave) = (x.0.max(y.0), x.1.min(y.1));
    if enter <= leave && enter > 0.0 { room.min(enter) } else { room }
}

fn scan(pose: &Pose2<f64>) -> RecordData {
    let (angle_min, angle_increment) = (-TAU / 2.0, TAU / 360.0);
    let ranges = (0..360).map(|beam| range(pose, angle_min + f64::from(beam) * angle_increment)).collect();
    RecordData::Scan(LaserScan { angle_min, angle_increment, range_max: 30.0, beam_period: 0.0, ranges })
}

/// A scan whose beams follow one another over `share` of the time to the next, with a period that the log states.
fn skewed_scan(step: usize, share: f64, beam_period: f64) -> RecordData {
    let (angle_min, angle_increment) = (-TAU / 2.0, TAU / 360.0);
    let beam_range = |beam: u32| {
        let pose = pose_after(step as f64 + share * f64::from(beam) / 360.0);
        range(&pose, angle_min + f64::from(beam) * angle_increment)
    };
    let ranges = (0..360).map(beam_range).collect();
    RecordData::Scan(LaserScan { angle_min, angle_increment, range_max: 30.0, beam_period, ranges })
}

/// The drive with scans that take `share` of a step, which the log states as `beam_period`; the odometry is right.
fn skewed_drive(share: f64, beam_period: f64) -> Vec<Record> {
    let mut records = drive(&every_step(), 0.0);
    let scans = records.iter_mut().filter(|record| matches!(record.data, RecordData::Scan(_)));
    for (step, record) in scans.enumerate() {
        record.data = skewed_scan(step, share, beam_period);
    }
    records
}

const N_STEPS: usize = 300;
const CONTRADICT: &str = "scans_contradict_odometry";

/// A drive whose odometry is `increments`, each with the step that it ends at, and `delay` seconds late.
fn drive(increments: &[(usize, Pose2<f64>)], delay: f64) -> Vec<Record> {
    let mut records = Vec::new();
    for step in 0..N_STEPS {
        let seconds = 10.0 + step as f64 * 0.1;
        records.push(at(seconds, RecordData::TruePose(pose(step))));
        records.push(at(seconds, scan(&pose(step))));
    }
    for (step, increment) in increments {
        records.push(at(10.0 + *step as f64 * 0.1 + delay, RecordData::OdometryIncrement(*increment)));
    }
    // Odometry comes before the scan of its stamp.
    records.sort_by_key(|record| (record.stamp, matches!(record.data, RecordData::Scan(_))));
    records
}

/// The motion by wheels that are one per cent smaller than they are taken for.
fn between(from: usize, to: usize) -> (usize, Pose2<f64>) {
    let moved = pose(from).inverse().compose(&pose(to));
    (to, Pose2::new(1.01 * moved.x(), moved.y(), moved.heading()))
}

fn every_step() -> Vec<(usize, Pose2<f64>)> {
    let still = (0, Pose2::new(0.0, 0.0, 0.0));
    std::iter::once(still).chain((1..N_STEPS).map(|step| between(step - 1, step))).collect()
}

fn run(records: &[Record], params: &WallSlamParams) -> WallRun {
    walls::run(records, params, |_| {}).expect("a usable log")
}

/// Largest position error, m, and mean NEES.
fn error_and_nees(run: &WallRun) -> (f64, f64) {
    let samples = run.samples();
    assert!(samples.len() > N_STEPS - 5, "{} scans", samples.len());
    let errors =
        samples.iter().map(|(_, sample)| (sample.estimate.translation - sample.truth.translation).norm());
    let nees = samples.iter().filter_map(|(_, sample)| sample.nees()).sum::<f64>();
    (errors.fold(0.0, f64::max), nees / samples.len() as f64)
}

fn assert_right(increments: &[(usize, Pose2<f64>)]) -> WallRun {
    let run = run(&drive(increments, 0.0), &WallSlamParams::default());
    let (error, nees) = error_and_nees(&run);
    assert!(error < CENTIMETRES && nees < CONSISTENT, "{error} m, NEES {nees}");
    run
}

#[test]
fn sound_odometry_says_nothing() {
    let mut run = assert_right(&every_step());
    let said = ["record_refused", "odometry_lags", "odometry_ends_early", CONTRADICT];
    assert_eq!(said.map(|name| run.events().get(name)), [0; 4]);
}

/// A bag often has the odometry and the commands.
#[test]
fn motion_told_twice_moves_once() {
    let mut records = drive(&every_step(), 0.0);
    let mut once = run(&records, &WallSlamParams::default());
    let commands = (0..N_STEPS).map(|step| {
        at(10.0 + step as f64 * 0.1, RecordData::Velocity(Velocity { linear: 1.0, angular: 0.5 }))
    });
    records.extend(commands);
    records.sort_by_key(|record| record.stamp);
    let mut twice = run(&records, &WallSlamParams::default());
    let second = |run: &mut WallRun| run.events().get("second_odometry_source_ignored");
    assert_eq!((second(&mut once), second(&mut twice)), (0, N_STEPS as u64));
    let last = |run: &WallRun| {
        *run.system.stamped_estimates().last().map(|estimate| estimate.pose).as_ref().expect("scans")
    };
    assert_eq!(last(&once), last(&twice));
}

#[test]
fn resumed_map_follows_the_odometry_of_its_log() {
    let records = drive(&every_step(), 0.0);
    let (before, after) = records.split_at(records.len() / 2);
    let saved = run(before, &WallSlamParams::default()).system.save();
    let velocity = |record: &Record| match record.data {
        RecordData::OdometryIncrement(moved) => {
            let velocity = Velocity { linear: 10.0 * moved.x(), angular: 10.0 * moved.heading() };
            Record { data: RecordData::Velocity(velocity), ..record.clone() }
        }
        _ => record.clone(),
    };
    let after: Vec<Record> = after.iter().map(velocity).collect();
    let mut resumed =
        walls::run_on(saved, &after, &after, &WallSlamParams::default(), None, |_| {}).expect("a usable log");
    assert_eq!(resumed.events().get("second_odometry_source_ignored"), 0);
    let travelled = |run: &WallRun| {
        let reckoned: Vec<_> = run.system.stamped_estimates().iter().map(|at| at.dead_reckoning).collect();
        reckoned.windows(2).map(|pair| (pair[1].translation - pair[0].translation).norm()).sum::<f64>()
    };
    assert!(travelled(&resumed) > 1.0, "{} m", travelled(&resumed));
}

#[test]
fn odometry_that_ends_early_is_said() {
    let mut run = run(&drive(&every_step()[..N_STEPS / 2], 0.0), &WallSlamParams::default());
    assert_eq!(run.events().get("odometry_ends_early"), 1);
}

#[test]
fn absurd_increment_is_lost_alone() {
    for x in [1e256, -1e200, f64::NAN, f64::INFINITY, 1e4] {
        let mut increments = every_step();
        increments[100].1 = Pose2::new(x, 0.0, 0.0);
        let mut run = assert_right(&increments);
        assert_eq!(run.events().get("record_refused"), 1, "{x}");
    }
}

#[test]
fn scans_bridge_a_gap_of_odometry() {
    let mut increments = every_step();
    increments.splice(101..150, []);
    increments[101] = between(100, 150);
    assert_right(&increments);
}

#[test]
fn scans_object_to_wheels_that_slip() {
    let mut increments = every_step();
    for (_, increment) in &mut increments[100..150] {
        *increment = Pose2::new(0.0, 0.0, 0.0);
    }
    assert_right(&increments);
}

#[test]
fn slow_odometry_is_interpolated_to_the_scans() {
    let still = (0, Pose2::new(0.0, 0.0, 0.0));
    let slow: Vec<_> = (10..N_STEPS).step_by(10).map(|step| between(step - 10, step)).collect();
    assert_right(&[&[still], slow.as_slice()].concat());
}

#[test]
fn late_odometry_is_said_and_its_delay_corrects_it() {
    let late = drive(&every_step(), 0.3);
    let mut as_it_is = run(&late, &WallSlamParams::default());
    let warnings = as_it_is.events().warnings().to_vec();
    let text = &warnings.iter().find(|warning| warning.name == "odometry_lags").expect("a warning").text;
    let said =
        text.split("odometry_delay = ").nth(1).and_then(|rest| rest.split('`').next()).expect("a delay");
    let odometry_delay: f64 = said.parse().expect("a number");
    assert!(abs_diff_eq!(odometry_delay, 0.3, epsilon = 0.05), "{text}");
    let corrected = WallSlamParams { odometry_delay: 0.3, ..WallSlamParams::default() };
    let mut corrected = run(&late, &corrected);
    assert_eq!(corrected.events().get("odometry_lags"), 0);
    let (error, nees) = error_and_nees(&corrected);
    assert!(error < CENTIMETRES && nees < CONSISTENT, "{error} m, NEES {nees}");
}

#[test]
fn velocity_holds_for_a_limited_time() {
    let look = RecordData::Detections(vec![Detection {
        target: DetectionTarget::Landmark(1),
        range: 2.0,
        bearing: 0.0,
    }]);
    let velocity = |linear| RecordData::Velocity(Velocity { linear, angular: 0.0 });
    let log =
        [at(0.0, velocity(1.0)), at(1e8, velocity(0.5)), at(1e8 + 0.5, look), at(1e8 + 0.6, velocity(0.5))];
    let params = PointSlamParams::of(RobotProfile::Generic);
    let mut run = points::run(&log, &params, |_| {}).expect("a usable log");
    let x = run.system.filter().robot().pose.x();
    assert!(abs_diff_eq!(x - params.robot.velocity_timeout, 0.3, epsilon = 1e-9), "{x} m");
    assert_eq!(run.events().get("motion_unknown"), 1);
    let sigma = run.system.filter().robot_covariance().m11.sqrt();
    assert!(sigma > 1e7, "unknown for 1e8 s at up to 1 m/s: {sigma} m");
}

/// A laser that turns ten times a second, on a robot that turns by up to 0.38 rad/s: the beams of one scan are up to 0.038 rad and 6 cm apart.
#[test]
fn motion_during_a_scan_is_taken_out_where_the_log_states_it() {
    let stated = skewed_drive(0.9, 0.09 / 360.0);
    let mut right = run(&stated, &WallSlamParams::default());
    let as_if_at_once = run(&stated, &WallSlamParams { deskew_scans: false, ..WallSlamParams::default() });
    let [(right_error, nees), (wrong_error, _)] = [&right, &as_if_at_once].map(error_and_nees);
    assert!(right_error < CENTIMETRES && nees < CONSISTENT, "{right_error} m, NEES {nees}");
    assert!(right_error < 0.5 * wrong_error, "{right_error} m with, {wrong_error} m without");
    assert!(right.events().get("scan_deskewed") > 290, "{}", right.events().get("scan_deskewed"));
}

#[test]
fn impossible_time_increment_is_said_and_not_used() {
    let mut run = run(&skewed_drive(0.0, 0.1), &WallSlamParams::default()); // the period of a scan in place of that of a beam
    let (error, nees) = error_and_nees(&run);
    assert!(error < CENTIMETRES && nees < CONSISTENT, "{error} m, NEES {nees}");
    assert_eq!(run.events().get("scan_deskewed"), 0);
    assert!(run.events().get("scan_duration_implausible") > 290);
}

/// The drive with scans changed by `change`, which gets their number.
fn changed_scans(change: impl Fn(usize, &mut Vec<f64>)) -> Vec<Record> {
    let mut records = drive(&every_step(), 0.0);
    let scans = records.iter_mut().filter_map(|record| match &mut record.data {
        RecordData::Scan(scan) => Some(&mut scan.ranges),
        _ => None,
    });
    scans.enumerate().for_each(|(step, ranges)| change(step, ranges));
    records
}

#[test]
fn scans_that_contradict_odometry_are_said() {
    let feet = |_, ranges: &mut Vec<f64>| ranges.iter_mut().for_each(|range| *range *= 0.3048);
    let mirrored = |_, ranges: &mut Vec<f64>| ranges[1..].reverse();
    let sideways = |_, ranges: &mut Vec<f64>| ranges.rotate_left(90);
    // The robot hides the laser's view of three quarters of the room.
    let itself = |_, ranges: &mut Vec<f64>| ranges[..270].fill(0.3);
    let changed =
        [changed_scans(feet), changed_scans(mirrored), changed_scans(sideways), changed_scans(itself)];
    for (at, records) in changed.iter().enumerate() {
        assert_eq!(run(records, &WallSlamParams::default()).events().get(CONTRADICT), 1, "change {at}");
    }
}

#[test]
fn laser_that_hangs_leaves_the_pose_to_odometry() {
    let RecordData::Scan(stuck) = scan(&pose(100)) else { unreachable!() };
    let records = changed_scans(|step, ranges| {
        if (100..150).contains(&step) {
            ranges.clone_from(&stuck.ranges);
        }
    });
    let mut run = run(&records, &WallSlamParams::default());
    let (error, nees) = error_and_nees(&run);
    assert_eq!(run.events().get("record_refused"), 49);
    // Wheels err by 1 % on these 3 m, and scans find the map again.
    assert!(error < 2.0 * CENTIMETRES && nees < CONSISTENT, "{error} m, NEES {nees}");
}

#[test]
fn laser_far_from_the_robot_is_said() {
    let mut records = drive(&every_step(), 0.0);
    records.insert(0, at(9.9, RecordData::LaserMount(Pose2::new(200.0, 0.0, 0.0))));
    assert!(run(&records, &WallSlamParams::default()).events().get("laser_mount_implausible") > 0);
}
