//! Increments, velocities, both, none and contradictory ones, in the localizers of images.

use std::sync::Arc;

use nalgebra::Vector3;
use wayfix_appearance_cml::PanoramaDescriptorParams;
use wayfix_estimation_traits::{LieGroup, Manifold, Pose2};
use wayfix_gaussian_core::Gaussian;
use wayfix_sensor_log::{AckermannDrive, LogOpenOptions, Record, RecordData, Velocity, open};
use wayfix_system_core::System;
use wayfix_systems::{
    cml::{
        self, CameraViewGeometry, CmlParams, CmlRunPlan, CmlRunSetup, CmlStartPose, CmlSystem, CmlTask,
        PanoramaMap, ViewDescriptorReader,
    },
    color::{self, ColorRunSetup, ColorSystemParams, priors, read_map},
};

/// The first `seconds` of a stored log.
fn log(name: &str, seconds: f64) -> Vec<Record> {
    let path = format!("{}/../../fixtures/{name}", env!("CARGO_MANIFEST_DIR"));
    let (records, _) = open(&path, &LogOpenOptions::default()).expect("a stored log").read_all();
    let end = records.first().expect("records").stamp.seconds() + seconds;
    records.into_iter().filter(|record| record.stamp.seconds() < end).collect()
}

fn is_increment(record: &Record) -> bool {
    matches!(record.data, RecordData::OdometryIncrement(_))
}

/// The velocities that make the increments of a log, each from the increment before on. A velocity has no sideways part.
fn velocities(records: &[Record]) -> Vec<Record> {
    let increments: Vec<&Record> = records.iter().filter(|record| is_increment(record)).collect();
    let velocity = |pair: &[&Record]| {
        let RecordData::OdometryIncrement(increment) = &pair[1].data else { return None };
        let rates: Vector3<f64> = increment.log() / pair[1].stamp.seconds_since(pair[0].stamp);
        let data = RecordData::Velocity(Velocity { linear: rates.x, angular: rates.z });
        Some(Record { stamp: pair[0].stamp, data })
    };
    increments.windows(2).filter_map(velocity).collect()
}

/// Sorted by stamp; records of one stamp keep their order, those of `first` before.
fn merged(first: Vec<Record>, second: Vec<Record>) -> Vec<Record> {
    let mut all = first;
    all.extend(second);
    all.sort_by_key(|record| record.stamp);
    all
}

fn without_increments(records: &[Record]) -> Vec<Record> {
    records.iter().filter(|record| !is_increment(record)).cloned().collect()
}

/// A slow odometry: every `n`-th increment, with the motion of those before.
fn slow(records: &[Record], n: usize) -> Vec<Record> {
    let (mut slow, mut moved, mut n_left) = (Vec::new(), Pose2::identity(), n);
    for record in records {
        let RecordData::OdometryIncrement(increment) = &record.data else {
            slow.push(record.clone());
            continue;
        };
        moved = moved.compose(increment);
        n_left -= 1;
        if n_left == 0 {
            let data = RecordData::OdometryIncrement(std::mem::replace(&mut moved, Pose2::identity()));
            slow.push(Record { stamp: record.stamp, data });
            n_left = n;
        }
    }
    slow
}

/// The estimates of a run, and how often an event happened.
struct Outcome {
    poses: Vec<Gaussian<Pose2<f64>>>,
    /// By odometry alone.
    reckoned: Vec<Pose2<f64>>,
    event: Box<dyn Fn(&str) -> u64>,
}

impl Outcome {
    fn last(&self) -> &Gaussian<Pose2<f64>> {
        self.poses.last().expect("estimates")
    }
}

fn outcome(poses: Vec<Gaussian<Pose2<f64>>>, reckoned: Vec<Pose2<f64>>, system: &mut impl System) -> Outcome {
    let counts = system.events().counts().clone();
    Outcome { poses, reckoned, event: Box::new(move |name| counts.get(name).copied().unwrap_or(0)) }
}

/// Appearance maps on a drive through a store.
fn cml(records: Vec<Record>) -> Outcome {
    let mut params = CmlParams::default();
    let plan = CmlRunPlan::of_log(records, 0, &mut params, &CameraViewGeometry::default()).expect("a plan");
    let start = cml::first_true_pose(&plan.records).expect("truth");
    let reader = ViewDescriptorReader::new(PanoramaDescriptorParams::default(), None);
    let system = CmlSystem::new(&params, reader, PanoramaMap::default()).expect("valid parameters");
    let (task, start) = (CmlTask::ConcurrentMapBuilding, CmlStartPose::Exactly(start));
    let setup = CmlRunSetup { system, plan: &plan, task, start, params: &params, seed: 1 };
    let mut run = cml::run(setup, |_| {}).expect("usable views");
    let poses = run.system.frames().iter().filter_map(|frame| frame.pose.clone()).collect();
    let reckoned = run.system.frames().iter().filter_map(|frame| frame.odometry).collect();
    outcome(poses, reckoned, &mut run.system)
}

/// Colour localization from near the truth. It searches for no other place: that takes most of the time, and what is asked here is how odometry moves the robot.
fn color(records: &[Record]) -> Outcome {
    let field = format!("{}/../../fixtures/four-legged-field.toml", env!("CARGO_MANIFEST_DIR"));
    let mut params = ColorSystemParams::default();
    params.localizer.search.samples_per_place = 0.0;
    let bank = priors::bank(&priors::built_in().expect("priors"), &params).expect("a bank");
    let map = Arc::new(read_map(field.as_ref()).expect("a map"));
    let setup = ColorRunSetup { map, bank, params, start: None, seed: 1 };
    let mut run = color::run(records, setup, |_| {}).expect("images");
    let poses = run.system.frames().iter().map(|frame| frame.pose.clone()).collect();
    let reckoned = run.system.frames().iter().filter_map(|frame| frame.odometry).collect();
    outcome(poses, reckoned, &mut run.system)
}

const SECOND_SOURCE: &str = "second_odometry_source_ignored";

#[test]
fn motion_told_twice_moves_once() {
    let store = log("store_area.mcap", 20.0);
    let (once, twice) = (cml(store.clone()), cml(merged(store.clone(), velocities(&store))));
    assert_eq!(once.poses, twice.poses);
    assert!((once.event)(SECOND_SOURCE) == 0 && (twice.event)(SECOND_SOURCE) > 20);

    let field = log("color_bright.mcap", 3.0);
    let (once, twice) = (color(&field), color(&merged(field.clone(), velocities(&field))));
    assert_eq!(once.poses, twice.poses);
    assert!((once.event)(SECOND_SOURCE) == 0 && (twice.event)(SECOND_SOURCE) > 20);
}

#[test]
fn velocities_move_the_robot_as_increments_do() {
    let store = log("store_area.mcap", 20.0);
    let by_velocities = cml(merged(velocities(&store), without_increments(&store)));
    let apart = cml(store).last().mean().local(by_velocities.last().mean());
    assert!(apart.xy().norm() < 0.05 && apart.z.abs() < 0.05, "{apart}");

    let field = log("color_bright.mcap", 6.0);
    let by_velocities = color(&merged(velocities(&field), without_increments(&field)));
    assert_eq!((by_velocities.event)("no_odometry"), 0);
    let apart = color(&field).last().mean().local(by_velocities.last().mean());
    assert!(apart.xy().norm() < 0.1 && apart.z.abs() < 0.1, "{apart}");
}

/// Ten images a second, odometry five times a second.
#[test]
fn images_between_increments_move_by_their_share() {
    let field = log("color_bright.mcap", 6.0);
    let (often, seldom) = (color(&field), color(&slow(&field, 2)));
    assert_eq!((seldom.event)("record_refused"), 0);
    // What is behind the last increment does not move.
    let pairs: Vec<_> = often.reckoned.iter().zip(&seldom.reckoned).take(50).collect();
    assert_eq!(pairs.len(), 50);
    for (often, seldom) in pairs {
        let apart = often.local(seldom);
        assert!(apart.xy().norm() < 0.02 && apart.z.abs() < 0.03, "{apart}");
    }
}

#[test]
fn missing_velocities_widen_the_belief() {
    let store = log("store_area.mcap", 20.0);
    let begin = store.first().expect("records").stamp.seconds();
    let mut moved = velocities(&store);
    let whole = cml(merged(moved.clone(), without_increments(&store)));
    moved.retain(|record| record.stamp.seconds() < begin + 14.0);
    let gap = cml(merged(moved, without_increments(&store)));
    assert!((whole.event)("motion_unknown") == 0 && (gap.event)("motion_unknown") > 0);
    let variance = |outcome: &Outcome| outcome.last().covariance().trace();
    assert!(variance(&gap) > 2.0 * variance(&whole), "{} {}", variance(&gap), variance(&whole));
}

#[test]
fn drives_of_a_car_do_not_stop_what_else_moves() {
    let store = log("store_area.mcap", 10.0);
    let stamp = store.first().expect("records").stamp;
    let drive = RecordData::Ackermann(AckermannDrive { wheel_speed: 0.0, steering: 0.0 });
    let with = merged(vec![Record { stamp, data: drive }], store.clone());
    assert_eq!(cml(with).poses, cml(store).poses);
}

#[test]
fn log_without_odometry_says_so() {
    let (store, field) = (log("store_area.mcap", 5.0), log("color_bright.mcap", 1.0));
    assert_eq!((cml(without_increments(&store)).event)("no_odometry"), 1);
    assert_eq!((color(&without_increments(&field)).event)("no_odometry"), 1);
    assert_eq!((color(&field).event)("no_odometry"), 0);
}

/// Without the increments after the first `seconds`.
fn ended(records: &[Record], seconds: f64) -> Vec<Record> {
    let begin = records.first().expect("records").stamp.seconds();
    let is_kept = |record: &&Record| !is_increment(record) || record.stamp.seconds() < begin + seconds;
    records.iter().filter(is_kept).cloned().collect()
}

#[test]
fn odometry_that_ends_early_is_said() {
    let (store, field) = (log("store_area.mcap", 10.0), log("color_bright.mcap", 3.0));
    let said = |run: Outcome| (run.event)("odometry_ends_early");
    assert_eq!([said(cml(ended(&store, 5.0))), said(cml(store))], [1, 0]);
    assert_eq!([said(color(&ended(&field, 1.0))), said(color(&field))], [1, 0]);
}

/// The drive of [`log`] with the turns of odometry multiplied.
fn with_turns(mut records: Vec<Record>, factor: f64) -> Vec<Record> {
    for record in &mut records {
        if let RecordData::OdometryIncrement(increment) = &mut record.data {
            *increment = Pose2::new(increment.x(), increment.y(), factor * increment.heading());
        }
    }
    records
}

#[test]
fn turns_of_odometry_that_views_contradict_are_said() {
    let store = log("store_area.mcap", 230.0);
    for (factor, n_said) in [(1.0, 0), (0.7, 1), (2.5, 1), (-1.0, 1)] {
        let run = cml(with_turns(store.clone(), factor));
        assert_eq!((run.event)("views_contradict_odometry"), n_said, "{factor}");
    }
}

/// A log in which the camera repeats an image twenty times.
fn hanging(mut records: Vec<Record>, first: usize) -> Vec<Record> {
    let images = records.iter_mut().filter_map(|record| match &mut record.data {
        RecordData::Image(image) => Some(image),
        _ => None,
    });
    let mut hanging = None;
    for image in images.skip(first).take(20) {
        *image = hanging.get_or_insert_with(|| image.clone()).clone();
    }
    records
}

#[test]
fn camera_that_hangs_does_not_hold_the_robot() {
    let field = log("color_bright.mcap", 9.0);
    let store = log("store_area.mcap", 20.0);
    let pairs = [(color(&field), color(&hanging(field, 30))), (cml(store.clone()), cml(hanging(store, 5)))];
    for (sound, hung) in pairs {
        assert!((hung.event)("record_refused") >= 15);
        let apart = sound.last().mean().local(hung.last().mean());
        assert!(apart.xy().norm() < 0.1 && apart.z.abs() < 0.1, "{apart}");
    }
}

#[test]
fn robot_without_motion_learns_nothing_and_says_so() {
    let mut store = log("store_area.mcap", 20.0);
    for record in &mut store {
        if let RecordData::OdometryIncrement(increment) = &mut record.data {
            *increment = Pose2::identity();
        }
    }
    assert_eq!((cml(store).event)("map_is_empty"), 1);
}
