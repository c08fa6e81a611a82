//! The smoother behind EKF-SLAM with points, and ranges without bearings, on logs.

#![allow(
    clippy::unwrap_used,
    clippy::expect_used,
    clippy::panic,
    reason = "a panic is the verdict of a test, in its helpers too"
)]

use approx::assert_abs_diff_eq;
use std::{collections::BTreeMap, path::Path};
use wayfix_slam_system::{
    points::{self, PointRun, PointSlamParams, RobotProfile, SavedPointMap},
    ranges,
    slam::{Smoothing, StampedEstimate},
};
use wayfix_system_core::RunStep;

use nalgebra::{Vector2, Vector3};
use wayfix_estimation_traits::{LieGroup, Manifold, Pose2};
use wayfix_sensor_log::{LogOpenOptions, Record, RecordData, Stamp};
use wayfix_slam_ekf::{AnchorParams, PoseWithRangeScale, SlamParams, SlamSnapshot};
use wayfix_table_log::{BeaconRangeRow, RangeRecording};

fn loop_records(smoothing: Smoothing) -> (Vec<Record>, PointSlamParams) {
    let path = Path::new(env!("CARGO_MANIFEST_DIR")).join("../../fixtures/loop_known.mcap");
    let log = wayfix_sensor_log::open(path, &LogOpenOptions::default()).unwrap();
    let profile = RobotProfile::of_log(log.meta());
    (log.read_all().0, PointSlamParams { smoothing, ..PointSlamParams::of(profile) })
}

fn loop_log(smoothing: Smoothing) -> PointRun {
    let (records, params) = loop_records(smoothing);
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

/// The run, and what it has saved after half of the records.
fn half_saved() -> (Vec<Record>, PointSlamParams, PointRun, SavedPointMap) {
    let (records, params) = loop_records(Smoothing::FixedLag);
    let (mut half, middle) = (None, records[records.len() / 2].stamp);
    let whole = points::run(&records, &params, |RunStep { system, record, next, .. }| {
        if record.stamp <= middle && next.is_some_and(|next| next.stamp > middle) {
            half = Some(system.save());
        }
    });
    (records, params, whole.expect("a usable log"), half.expect("a stamp in the middle"))
}

#[test]
fn saving_changes_nothing_and_a_resumed_window_goes_on() {
    let (records, params, mut whole, half) = half_saved();
    let bytes = half.to_bytes().unwrap();
    let half = SavedPointMap::from_bytes(&bytes).unwrap();
    let resumed = points::run_on(half, &records, &records, &params, |_| {}).expect("a usable log");
    let unsaved = loop_log(Smoothing::FixedLag);
    let poses = |run: &PointRun| {
        let estimates = run.system.stamped_estimates();
        estimates.iter().map(|at| (at.stamp, at.pose)).collect::<Vec<_>>()
    };
    assert_eq!(poses(&whole), poses(&unsaved));
    assert_eq!(whole.events().get("smoother_starts_from_filter"), 0);
    // The filter goes on bit for bit; of the window only the linearization is lost: a tenth of σ makes an error larger by 1 %.
    assert_eq!(resumed.system.save().filter, whole.system.save().filter);
    let expected: BTreeMap<_, _> = whole.system.stamped_estimates().iter().map(|at| (at.stamp, at)).collect();
    let squared = |found: &StampedEstimate| {
        let expected = expected[&found.stamp];
        let difference = found.pose.local(&expected.pose);
        difference.dot(&expected.covariance.cholesky().unwrap().solve(&difference))
    };
    let found = resumed.system.stamped_estimates();
    assert!(found.len() > 20 && found.len() < expected.len());
    let mean = found.iter().map(squared).sum::<f64>() / found.len() as f64;
    assert!(mean < 3.0 * 0.1_f64.powi(2), "{mean}");
}

#[test]
fn saved_window_that_is_no_gaussian_is_refused() {
    let (records, params, _, half) = half_saved();
    let resume = |saved: SavedPointMap| points::run_on(saved, &records, &records, &params, |_| {});
    let with = |change: fn(&mut SlamSnapshot<PoseWithRangeScale, Vector2<f64>>)| {
        let mut bad = half.clone();
        bad.smoothed.iter_mut().for_each(change);
        SavedPointMap::from_bytes(&bad.to_bytes().unwrap()).unwrap()
    };
    for bad in [
        with(|window| window.robot.pose.translation.x = f64::NAN),
        with(|window| window.landmarks[1].mean.y = f64::INFINITY),
        with(|window| window.landmarks[1].id = window.landmarks[0].id),
        with(|window| window.covariance.truncate(7)),
        with(|window| window.covariance[0] = -1.0),
        with(|window| window.covariance[1] = 1e6),
    ] {
        let error = resume(bad).err().expect("no Gaussian").to_string();
        assert!(error.contains("not a state of the filter"), "{error}");
    }
    // Semidefinite is enough for a filter; the smoother inverts it.
    let semidefinite = with(|window| {
        let n = 4 + 2 * window.landmarks.len();
        window.set_covariance(&nalgebra::DMatrix::from_element(n, n, 1.0));
    });
    let error = resume(semidefinite).err().expect("no Gaussian").to_string();
    assert!(error.contains("not a start of the smoother") && error.contains("positive definite"), "{error}");
    let of_filter = SavedPointMap { smoothed: None, ..half.clone() };
    assert_eq!(resume(of_filter).unwrap().events().get("smoother_starts_from_filter"), 1);
}

#[test]
fn start_that_the_smoother_refuses_is_reported_with_its_reason() {
    let (records, params) = loop_records(Smoothing::Off);
    let anchors =
        vec![AnchorParams { id: 1, at: [0.0, 0.0], covariance: Some([[0.01, 0.0], [0.0, 1e-310]]) }];
    let run = |smoothing| {
        let params = PointSlamParams { anchors: anchors.clone(), smoothing, ..params.clone() };
        points::run(&records, &params, |_| {})
    };
    let error = run(Smoothing::FixedLag).err().expect("no finite information").to_string();
    assert!(
        error.contains("not a start of the smoother: the information of residual 0 is not finite"),
        "{error}"
    );
    assert_eq!(run(Smoothing::Reference).expect("a filter").events().get("smoother_failed"), 1);
}

#[test]
fn anchors_hold_the_map_of_the_smoother() {
    let (records, params) = loop_records(Smoothing::FixedLag);
    let run = |params: &PointSlamParams| points::run(&records, params, |_| {}).expect("a usable log");
    let places = |run: &PointRun| run.smoothed.as_ref().expect("smoothed").landmarks.clone();
    let free = run(&params);
    let is_seen = |(id, _): &(&u32, &Vector2<f64>)| places(&free).contains_key(id);
    let (id, place) =
        free.true_map.iter().find(is_seen).map(|(id, place)| (*id, *place)).expect("a seen one");
    assert!((places(&free)[&id] - place).norm() > 1e-3);
    for (covariance, most) in [(None, 0.0), (Some([[1e-8, 0.0], [0.0, 1e-8]]), 1e-3)] {
        let anchor = AnchorParams { id, at: [place.x, place.y], covariance };
        let anchored = run(&PointSlamParams { anchors: vec![anchor], ..params.clone() });
        // Ten standard deviations of 0.1 mm; without a covariance it is exact.
        assert!((places(&anchored)[&id] - place).norm() <= most);
    }
    let first = PointSlamParams { filter: SlamParams { anchor_first: 1, ..params.filter }, ..params.clone() };
    let first = run(&first);
    let anchors: Vec<_> = first.system.filter().anchors().collect();
    assert_eq!((anchors.len(), places(&first)[&anchors[0].0.0]), (1, *anchors[0].1));
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
