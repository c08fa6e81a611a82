//! Other estimators of the pose beside views and odometry in the appearance localizer. [Gross et al. 2005, Fig. 2]

use nalgebra::{Matrix3, Vector2, Vector3};
use rand::SeedableRng;
use rand_chacha::ChaCha8Rng;
use rand_distr::{Distribution, Normal};
use wayfix_appearance_cml::{LocalizerParams, PanoramaDescriptorParams};
use wayfix_estimation_traits::Pose2;
use wayfix_sensor_log::{
    LogOpenOptions, MeasuredQuantity, PoseMeasurement, Record, RecordData, Stamp, open, topics,
};
use wayfix_slam_ekf::ExternalParams;
use wayfix_system_core::System;
use wayfix_systems::cml::{
    self, CameraViewGeometry, CmlParams, CmlRun, CmlRunPlan, CmlRunSetup, CmlStartPose, CmlSystem, CmlTask,
    PanoramaMap, ViewDescriptorReader,
};

const SIGMA: f64 = 0.05;

/// The first minute of a drive in a store.
fn drive() -> Vec<Record> {
    let log = concat!(env!("CARGO_MANIFEST_DIR"), "/../../fixtures/store_area.mcap");
    let (records, _) = open(log, &LogOpenOptions::default()).expect("a stored log").read_all();
    let end = records.first().expect("records").stamp.seconds() + 60.0;
    records.into_iter().filter(|record| record.stamp.seconds() < end).collect()
}

fn localized(records: Vec<Record>) -> CmlRun {
    localized_by(records, LocalizerParams::default())
}

fn localized_by(records: Vec<Record>, localizer: LocalizerParams) -> CmlRun {
    let external = ExternalParams {
        map_frame_ids: vec!["map".to_owned(), topics::WORLD_FRAME.to_owned()],
        ..ExternalParams::default()
    };
    let mut params = CmlParams { external, localizer, ..CmlParams::default() };
    let plan = CmlRunPlan::of_log(records, 0, &mut params, &CameraViewGeometry::default()).expect("a plan");
    let start = cml::first_true_pose(&plan.records).expect("truth");
    let reader = ViewDescriptorReader::new(PanoramaDescriptorParams::default(), None);
    let system = CmlSystem::new(&params, reader, PanoramaMap::default()).expect("valid parameters");
    let task = CmlTask::ConcurrentMapBuilding;
    let start = CmlStartPose::Exactly(start);
    let setup = CmlRunSetup { system, plan: &plan, task, start, params: &params, seed: 1 };
    cml::run(setup, |_| {}).expect("usable views")
}

fn measured(stamp: Stamp, frame: &str, quantity: MeasuredQuantity, sigma: Option<f64>) -> Record {
    let covariance = sigma.map(|sigma| Matrix3::from_diagonal(&Vector3::repeat(sigma * sigma)));
    let frame = frame.to_owned();
    Record { stamp, data: RecordData::PoseMeasurement(PoseMeasurement { frame, quantity, covariance }) }
}

/// The log with a measurement after every true pose that is a second after the last one.
fn with(records: &[Record], mut measure: impl FnMut(Stamp, &Pose2<f64>) -> Record) -> (Vec<Record>, u64) {
    let (mut all, mut last, mut n) = (Vec::new(), f64::NEG_INFINITY, 0);
    for record in records {
        all.push(record.clone());
        if let RecordData::TruePose(pose) = &record.data
            && record.stamp.seconds() >= last + 1.0
        {
            (last, n) = (record.stamp.seconds(), n + 1);
            all.push(measure(record.stamp, pose));
        }
    }
    (all, n)
}

fn poses(run: &CmlRun) -> Vec<Option<Pose2<f64>>> {
    run.system.frames().iter().map(|frame| frame.pose.as_ref().map(|pose| *pose.mean())).collect()
}

fn mean_error(run: &CmlRun) -> f64 {
    let samples = run.samples();
    samples.iter().map(|(_, sample)| sample.position_error()).sum::<f64>() / samples.len() as f64
}

#[test]
fn positions_headings_and_poses_correct_the_belief() {
    let records = drive();
    let without = mean_error(&localized(records.clone()));
    let mut rng = ChaCha8Rng::seed_from_u64(7);
    let mut error = || Normal::new(0.0, SIGMA).expect("a sigma").sample(&mut rng);
    for kind in ["position", "pose"] {
        let (all, n) = with(&records, |stamp, pose| {
            let position = pose.translation + Vector2::new(error(), error());
            let quantity = match kind {
                "position" => MeasuredQuantity::Position(position),
                _ => MeasuredQuantity::Pose(Pose2::new(position.x, position.y, pose.heading() + error())),
            };
            measured(stamp, "map", quantity, Some(SIGMA))
        });
        let mut run = localized(all);
        let accepted = run.system.events().get("measurement_accepted");
        println!("{kind}: {accepted} of {n}, error {:.3} m, without {without:.3} m", mean_error(&run));
        assert!(accepted + 1 >= n && mean_error(&run) < without, "{kind}");
    }
    let (all, n) = with(&records, |stamp, pose| {
        measured(stamp, "map", MeasuredQuantity::Heading(pose.heading() + error()), Some(SIGMA))
    });
    let mut run = localized(all);
    let [accepted, withheld] =
        ["measurement_accepted", "measurement_withheld"].map(|event| run.system.events().get(event));
    assert!(accepted > 0 && accepted + withheld + 1 >= n, "{accepted} + {withheld} of {n}");
}

#[test]
fn as_published_measurements_are_intersected() {
    let records = drive();
    let mut rng = ChaCha8Rng::seed_from_u64(7);
    let mut error = || Normal::new(0.0, SIGMA).expect("a sigma").sample(&mut rng);
    let (all, n) = with(&records, |stamp, pose| {
        let position = pose.translation + Vector2::new(error(), error());
        measured(stamp, "map", MeasuredQuantity::Position(position), Some(SIGMA))
    });
    let [published, default] =
        [LocalizerParams::as_published(), LocalizerParams::default()].map(|p| localized_by(all.clone(), p));
    let without = localized_by(records, LocalizerParams::as_published());
    let [error, default_error, error_without] = [&published, &default, &without].map(mean_error);
    let accepted = { published }.system.events().get("measurement_accepted");
    println!(
        "{accepted} of {n}: {error:.3} m, by default {default_error:.3} m, without {error_without:.3} m"
    );
    assert!(accepted + 1 >= n && error < error_without && error != default_error);
}

/// Stand-ins for two cameras: every other image of one.
fn of_camera(records: &[Record], camera: usize) -> Vec<Record> {
    let mut n_images = 0;
    let is_kept = |record: &&Record| {
        n_images += usize::from(matches!(record.data, RecordData::Image(_)));
        !matches!(record.data, RecordData::Image(_)) || n_images % 2 == camera
    };
    records.iter().filter(is_kept).cloned().collect()
}

/// The matches of a camera whose map was learned with true poses correct the run of another, whose map grows.
#[test]
fn a_second_camera_corrects_the_first() {
    let records = drive();
    let mut params = CmlParams::default();
    let second = of_camera(&records, 1);
    let plan = CmlRunPlan::of_log(second, 2, &mut params, &CameraViewGeometry::default()).expect("a plan");
    let reader = ViewDescriptorReader::new(PanoramaDescriptorParams::default(), None);
    let system = CmlSystem::new(&params, reader, PanoramaMap::default()).expect("valid parameters");
    let start = CmlStartPose::Anywhere;
    let task = CmlTask::LearnThenLocalize;
    let setup = CmlRunSetup { system, plan: &plan, task, start, params: &params, seed: 1 };
    let matched = cml::run(setup, |_| {}).expect("usable views");
    let measurements = matched.system.frames().iter().filter_map(|frame| {
        let data = RecordData::PoseMeasurement(frame.pose_measurement()?);
        Some(Record { stamp: frame.stamp, data })
    });
    let first = of_camera(&records, 0);
    let without = mean_error(&localized(first.clone()));
    let mut both: Vec<Record> = first.into_iter().chain(measurements).collect();
    both.sort_by_key(|record| record.stamp);
    let mut run = localized(both);
    let [accepted, gated] =
        ["measurement_accepted", "measurement_gated"].map(|event| run.system.events().get(event));
    let error = mean_error(&run);
    println!("{accepted} accepted, {gated} gated, error {error:.3} m, without {without:.3} m");
    assert!(accepted > 10 * gated && error < without);
}

#[test]
fn useless_measurements_are_counted_and_leave_the_belief() {
    let records = drive();
    let clean = localized(records.clone());
    let position = |pose: &Pose2<f64>| MeasuredQuantity::Position(pose.translation);
    type Measure<'a> = &'a dyn Fn(Stamp, &Pose2<f64>) -> Record;
    let cases: [(&str, Measure<'_>, &str); 5] = [
        ("no covariance", &|stamp, pose| measured(stamp, "map", position(pose), None), "record_refused"),
        (
            "another frame",
            &|stamp, pose| measured(stamp, "odom", position(pose), Some(SIGMA)),
            "record_refused",
        ),
        (
            "not finite",
            &|stamp, _| measured(stamp, "map", MeasuredQuantity::Heading(f64::NAN), Some(SIGMA)),
            "measurement_gated",
        ),
        (
            "a jump of 100 m",
            &|stamp, pose| {
                let far = MeasuredQuantity::Position(pose.translation + Vector2::new(100.0, 0.0));
                measured(stamp, "map", far, Some(SIGMA))
            },
            "measurement_gated",
        ),
        (
            "a mirrored compass",
            &|stamp, pose| measured(stamp, "map", MeasuredQuantity::Heading(-pose.heading()), Some(SIGMA)),
            "measurement_gated",
        ),
    ];
    for (name, measure, event) in cases {
        let (all, n) = with(&records, measure);
        let mut run = localized(all);
        let events = run.system.events();
        assert_eq!(events.get("measurement_accepted"), 0, "{name}");
        assert_eq!(events.get(event) + events.get("measurement_withheld"), n, "{name}");
        assert!(events.get(event) > 0, "{name}");
        assert_eq!(events.get("compass_mirrored"), u64::from(name == "a mirrored compass"), "{name}");
        let moved = poses(&run)
            .iter()
            .zip(poses(&clean))
            .filter_map(|(a, b)| Some((a.as_ref()?.translation - b?.translation).norm()))
            .fold(0.0, f64::max);
        // An increment is cut at the stamp of a measurement that waits.
        assert!(moved < 1e-6, "{name} moves the robot by {moved} m");
    }
}
