//! What the SLAM system makes of records: timing, calibration, and refusals that leave no trace.

use approx::{abs_diff_eq, assert_abs_diff_eq};
use std::f64::consts::FRAC_PI_3;
use wayfix_slam_system::points::{
    PointRun, PointSlamParams, RobotProfile, RobotTimingParams, run, summarize,
};

use nalgebra::Vector2;
use wayfix_estimation_traits::{LieGroup, Pose2};
use wayfix_sensor_log::{
    Detection, DetectionTarget, LogOpenOptions, Record, RecordData, Stamp, TrueLandmark, Velocity,
};

fn at(seconds: f64, data: RecordData) -> Record {
    Record { stamp: Stamp::from_seconds(seconds).expect("a time"), data }
}

fn velocity(seconds: f64, linear: f64, angular: f64) -> Record {
    at(seconds, RecordData::Velocity(Velocity { linear, angular }))
}

fn detection(seconds: f64, id: u32, range: f64, bearing: f64) -> Record {
    at(
        seconds,
        RecordData::Detections(vec![Detection { target: DetectionTarget::Landmark(id), range, bearing }]),
    )
}

fn slam(records: &[Record], robot: RobotTimingParams) -> PointRun {
    let params = PointSlamParams { robot, ..PointSlamParams::of(RobotProfile::Generic) };
    run(records, &params, |_| {}).expect("a usable log")
}

#[test]
fn delayed_detection_corrects_the_past_pose() {
    let robot = RobotTimingParams { sensor_latency: 0.25, ..RobotTimingParams::default() };
    let slam = slam(&[velocity(0.0, 1.0, 0.0), detection(1.0, 7, 2.0, 0.0)], robot);
    let stamped_estimate = slam.system.stamped_estimates()[0];
    assert!(abs_diff_eq!(slam.system.filter().robot().pose.x(), 0.75, epsilon = 1e-12), "at the exposure");
    assert!(abs_diff_eq!(stamped_estimate.pose.x(), 1.0, epsilon = 1e-12), "at the stamp");
    // One second of a random walk of 0.02 m/√s, a quarter of it after the exposure.
    assert_abs_diff_eq!(stamped_estimate.covariance.m11.sqrt(), 0.02, epsilon = 1e-9);
}

#[test]
fn a_delayed_command_moves_the_robot_later() {
    let robot = RobotTimingParams { command_delay: 0.5, ..RobotTimingParams::default() };
    let records = [velocity(0.0, 1.0, 0.0), velocity(1.0, 1.0, 0.0), detection(2.0, 7, 2.0, 0.0)];
    let slam = slam(&records, robot);
    assert_abs_diff_eq!(slam.system.stamped_estimates()[0].pose.x(), 1.5, epsilon = 1e-12);
}

#[test]
fn depth_becomes_distance() {
    let robot = RobotTimingParams { range_is_depth: true, ..RobotTimingParams::default() };
    let looks =
        [velocity(0.0, 0.0, 0.0), detection(0.1, 7, 1.0, FRAC_PI_3), detection(0.2, 7, 1.0, FRAC_PI_3)];
    let slam = slam(&looks, robot);
    let position = slam.landmarks()[&7];
    assert!(
        abs_diff_eq!(position.x, 1.0, epsilon = 1e-9)
            && abs_diff_eq!(position.y, 3.0_f64.sqrt(), epsilon = 1e-9),
        "{position}"
    );
}

#[test]
fn a_refused_record_leaves_no_trace() {
    let good = [
        velocity(0.0, 0.5, 0.1),
        detection(0.5, 7, 2.0, 0.3),
        velocity(1.0, 0.4, -0.2),
        detection(1.5, 7, 1.5, 0.4),
        detection(2.0, 7, 1.3, 0.5),
    ];
    let bad = [
        velocity(1.2, f64::NAN, 0.0),
        velocity(1.2, 0.1, f64::INFINITY),
        velocity(1.2, 1e300, 0.0),
        velocity(0.2, 0.5, 0.0), // back in time
    ];
    let clean = slam(&good, RobotTimingParams::default());
    for record in bad {
        let mut records = good.to_vec();
        records.insert(3, record.clone());
        let mut slam = slam(&records, RobotTimingParams::default());
        assert_eq!(slam.events().get("record_refused"), 1, "{record:?}");
        assert_eq!(slam.events().refusals()[0].index, 3);
        assert_eq!(slam.system.filter().robot(), clean.system.filter().robot(), "{record:?}");
        assert_eq!(slam.system.filter().covariance(), clean.system.filter().covariance(), "{record:?}");
    }
}

#[test]
fn non_finite_measurement_is_counted_and_changes_nothing() {
    let look = |more: &[Detection]| {
        let first = Detection { target: DetectionTarget::Landmark(7), range: 2.0, bearing: 0.3 };
        at(0.5, RecordData::Detections([&[first], more].concat()))
    };
    let detection = |id, range, bearing| Detection { target: DetectionTarget::Landmark(id), range, bearing };
    let bad = [
        detection(8, f64::NAN, 0.0),
        detection(8, 1.0, f64::NAN),
        detection(8, f64::INFINITY, 0.0),
        detection(8, 0.0, 0.0),
        detection(8, -1.0, 0.0),
        detection(8, 1.0, f64::NEG_INFINITY),
    ];
    let clean = slam(&[velocity(0.0, 0.5, 0.1), look(&[])], RobotTimingParams::default());
    let mut slam = slam(&[velocity(0.0, 0.5, 0.1), look(&bad)], RobotTimingParams::default());
    assert_eq!(slam.events().get("observation_unusable"), bad.len() as u64);
    assert_eq!(slam.system.filter().robot(), clean.system.filter().robot());
    assert_eq!(slam.system.filter().covariance(), clean.system.filter().covariance());
}

#[test]
fn the_run_starts_at_the_truth_where_odometry_starts() {
    let truth = |seconds: f64, x: f64| at(seconds, RecordData::TruePose(Pose2::new(x, 0.0, 0.0)));
    let records = [truth(0.0, 5.0), truth(0.2, 6.0), velocity(0.1, 0.0, 0.0), detection(0.2, 7, 1.0, 0.0)];
    let mut records = records.to_vec();
    records.sort_by_key(|record| record.stamp);
    let slam = slam(&records, RobotTimingParams::default());
    assert_abs_diff_eq!(slam.system.stamped_estimates()[0].dead_reckoning.x(), 5.5, epsilon = 1e-12);
}

#[test]
fn two_anchors_tie_the_map_to_the_world() {
    let landmark = |id, x, y| at(0.0, RecordData::TrueLandmark(TrueLandmark { id, x, y }));
    let mut records = vec![landmark(7, 2.0, 0.5), landmark(8, 1.5, -1.0), landmark(9, 9.0, 4.0)];
    records.push(velocity(0.0, 0.5, 0.1));
    for step in 1..10 {
        let pose = Pose2::new(0.05 * f64::from(step), 0.0, 0.01 * f64::from(step));
        let detections = [(7, 2.0, 0.5), (8, 1.5, -1.0), (9, 9.0, 4.0)].map(|(id, x, y)| {
            let seen = pose.inverse().transform(&Vector2::new(x, y));
            Detection {
                target: DetectionTarget::Landmark(id),
                range: seen.norm(),
                bearing: seen.y.atan2(seen.x),
            }
        });
        records.push(at(0.1 * f64::from(step), RecordData::Detections(detections.to_vec())));
    }
    for (n_anchors, n_free) in [(0, 3), (1, 1), (2, 0)] {
        let params = PointSlamParams {
            n_anchors,
            record_observability: true,
            ..PointSlamParams::of(RobotProfile::Generic)
        };
        let run = run(&records, &params, |_| {}).expect("a usable log");
        assert_eq!(run.system.filter().anchors().count(), n_anchors);
        let recorder = run.system.observability().expect("recorded");
        assert_eq!(recorder.unobservable_directions().len(), n_free, "{n_anchors} anchors");
    }
}

/// Retirement alone makes the filter dishonest on many laps: an anchor does not, and the run says so.
#[test]
fn retired_landmarks_are_said_and_an_anchor_is_no_fault() {
    let log = concat!(env!("CARGO_MANIFEST_DIR"), "/../../fixtures/long_loop.mcap");
    let (records, _) =
        wayfix_sensor_log::open(log, &LogOpenOptions::default()).expect("a stored log").read_all();
    let nees = |anchor_first: usize, retire_after: Option<usize>| {
        let mut params = PointSlamParams::of(RobotProfile::RangeBearing);
        (params.filter.anchor_first, params.filter.retire_after) = (anchor_first, retire_after);
        let mut run = run(&records, &params, |_| {}).expect("a usable log");
        assert_eq!(run.events().get("landmarks_retired"), u64::from(retire_after.is_some()));
        let summary = summarize(&mut run);
        summary.metrics.iter().find(|metric| metric.name == "nees_mean").expect("truth").value
    };
    let [standard, anchored, retired] = [(0, None), (1, None), (0, Some(50))].map(|(a, r)| nees(a, r));
    println!("NEES: standard {standard:.1}, anchored {anchored:.1}, retired {retired:.1}");
    // The standard filter is inconsistent here already; what counts is what each option adds.
    assert_abs_diff_eq!(anchored, standard, epsilon = 0.1 * (retired - standard));
}

#[test]
fn truth_of_another_log_is_suspected() {
    let log = concat!(env!("CARGO_MANIFEST_DIR"), "/../../fixtures/loop_known.mcap");
    let (mut records, _) =
        wayfix_sensor_log::open(log, &LogOpenOptions::default()).expect("a stored log").read_all();
    let params = PointSlamParams::of(RobotProfile::RangeBearing);
    let suspected = |records: &[Record]| {
        run(records, &params, |_| {}).expect("a usable log").events().get("errors_exceed_covariances")
    };
    assert_eq!(suspected(&records), 0);
    // Another robot, that stands.
    for record in &mut records {
        if let RecordData::TruePose(pose) = &mut record.data {
            *pose = Pose2::new(0.0, 0.0, 0.0);
        }
    }
    assert_eq!(suspected(&records), 1);
}
