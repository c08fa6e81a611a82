//! The smoother behind EKF-SLAM with points, and ranges without bearings, on logs.

#![allow(
    clippy::unwrap_used,
    clippy::expect_used,
    clippy::panic,
    reason = "a panic is the verdict of a test, in its helpers too"
)]

use approx::assert_abs_diff_eq;
use std::path::Path;

use nalgebra::{Vector2, Vector3};
use wayfix_estimation_traits::{LieGroup, Pose2};
use wayfix_sensor_log::{LogOpenOptions, Record, RecordData, Stamp};
use wayfix_systems::{
    points::{self, PointRun, PointSlamParams, RobotProfile},
    ranges,
    slam::Smoothing,
};
use wayfix_table_log::{BeaconRangeRow, RangeRecording};

fn loop_log(smoothing: Smoothing) -> PointRun {
    let path = Path::new(env!("CARGO_MANIFEST_DIR")).join("../../fixtures/loop_known.mcap");
    let log = wayfix_sensor_log::open(path, &LogOpenOptions::default()).unwrap();
    let profile = RobotProfile::of_log(log.meta());
    let (records, _) = log.read_all();
    let params = PointSlamParams { smoothing, ..PointSlamParams::of(profile) };
    points::run(&records, &params, |_| {}).expect("a usable log")
}

fn figure(run: &mut PointRun, name: &str) -> Option<f64> {
    points::summarize(run).metrics.iter().find(|metric| metric.name == name).map(|metric| metric.value)
}

#[test]
fn window_beats_the_filter_and_the_batch_leaves_it_alone() {
    let mut filter = loop_log(Smoothing::Off);
    let mut reference = loop_log(Smoothing::Reference);
    let mut window = loop_log(Smoothing::FixedLag);
    let poses = |run: &PointRun| {
        let estimates = run.system.stamped_estimates();
        estimates.iter().map(|estimate| (estimate.stamp, estimate.pose)).collect::<Vec<_>>()
    };
    assert_eq!(poses(&filter), poses(&reference));
    assert_eq!(poses(&filter).len(), poses(&window).len());
    let name = "ate_aligned_rmse_m";
    let [of_filter, of_window] = [&mut filter, &mut window].map(|run| figure(run, name).unwrap());
    assert!(of_window <= of_filter, "{of_window} {of_filter}");
    assert!(figure(&mut filter, "batch_ate_aligned_rmse_m").is_none());
    let batch = figure(&mut reference, "batch_ate_aligned_rmse_m").unwrap();
    assert!(of_window <= 1.1 * batch, "{of_window} {batch}");
    // An overconfident estimate would have far more than 3.
    assert!(figure(&mut window, "nees_mean").unwrap() < 6.0);
    assert_eq!(window.events().get("smoother_failed"), 0);
}

/// A curved drive with two beacons; ranges are 1 m too long.
fn recording() -> (RangeRecording, Vec<Record>) {
    let beacons = [(1, Vector2::new(15.0, -3.0)), (8, Vector2::new(-4.0, 12.0))];
    let mut recording = RangeRecording::default();
    let mut robot = Pose2::new(1.0, 2.0, 0.4);
    let mut truth = Vec::new();
    for k in 0..400 {
        let stamp = Stamp::from_seconds(100.0 + 0.2 * f64::from(k)).unwrap();
        let motion = Pose2::exp(&Vector3::new(0.2, 0.0, 0.05 * (f64::from(k) / 60.0).sin()));
        if k > 0 {
            robot = robot.compose(&motion);
        }
        recording.odometry.push((stamp, motion));
        truth.push(Record { stamp, data: RecordData::TruePose(robot) });
        let (beacon, place) = beacons[k as usize % 2];
        // A fixed sequence that looks like noise of 0.1 m.
        let noise = 0.14 * (7.3 * f64::from(k * k % 97)).sin();
        let range = (place - robot.translation).norm() + 1.0 + noise;
        recording.ranges.push(BeaconRangeRow { stamp, beacon, range });
    }
    (recording, truth)
}

#[test]
fn ranges_place_beacons_and_say_what_is_assumed() {
    let (recording, truth) = recording();
    let run = ranges::run(&recording, &truth).unwrap();
    let place = run.estimate.beacons[&1].0;
    assert!((place - Vector2::new(15.0, -3.0)).norm() < 0.5, "{place}");
    assert_abs_diff_eq!(
        run.estimate.calibration.bias,
        1.0,
        epsilon = 5.0 * run.estimate.calibration_sigma.bias
    );
    let summary = ranges::summarize(&run);
    let has = |name: &str| summary.metrics.iter().any(|metric| metric.name == name);
    assert!(
        ["ate_rmse_m", "ate_aligned_rmse_m", "nees_mean", "n_landmarks", "range_bias_m"].into_iter().all(has)
    );
    let said = |name: &str| run.events.warnings().iter().any(|warning| warning.name == name);
    assert!(
        said("receiver_calibration_estimated")
            && said("noise_estimated")
            && said("odometry_scale_and_direction_unknown")
    );
    assert!(ranges::plots(&run).unwrap().len() >= 2);
}

#[test]
fn unusable_ranges_are_counted_and_empty_recordings_refused() {
    let (mut recording, _) = recording();
    recording.ranges[5].range = f64::NAN;
    recording.ranges[6].range = 0.0;
    recording.ranges[399].stamp = Stamp::from_seconds(1e4).unwrap();
    recording.ranges[0].stamp = Stamp::from_seconds(1.0).unwrap();
    recording.ranges[7].beacon = u32::MAX;
    let run = ranges::run(&recording, &[]).unwrap();
    for (name, n) in [("observation_unusable", 2), ("record_after_odometry", 1), ("record_before_start", 1)] {
        assert_eq!(run.events.get(name), n, "{name}");
    }
    let said = |name: &str| run.events.warnings().iter().any(|warning| warning.name == name);
    assert!(said("start_pose_unknown") && said("beacon_not_placed"));
    for (odometry, ranges) in
        [(Vec::new(), recording.ranges.clone()), (recording.odometry.clone(), Vec::new())]
    {
        let empty = RangeRecording { odometry, ranges, ..RangeRecording::default() };
        assert!(ranges::run(&empty, &[]).is_err());
    }
}
