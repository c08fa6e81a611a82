//! The monobot's samples have the distribution that the paper gives them.

use crate::support::{assert_near, deviation, mean, streams};
use approx::assert_abs_diff_eq;
use wayfix_scene_sim::monobot::{MonobotParams, MonobotRun};
use wayfix_sensor_log::{RecordData, Stamp};

fn runs(params: MonobotParams, n: u64) -> Vec<MonobotRun> {
    (0..n).map(|seed| params.simulate(&mut streams(seed)).expect("valid parameters")).collect()
}

#[test]
fn without_noise_it_follows_the_sine_and_returns() {
    let silent = MonobotParams {
        motion_sigma_share: 0.0,
        range_sigma_share: 0.0,
        external_position_sigma_m: 0.0,
        ..MonobotParams::default()
    };
    let run = &runs(silent, 1)[0];
    assert_abs_diff_eq!(run.positions[25], 0.0, epsilon = 1e-12);
    assert_abs_diff_eq!(run.positions[75], -2.0, epsilon = 1e-12);
    assert_abs_diff_eq!(run.positions[100], -1.0, epsilon = 1e-12);
    for (k, x) in run.positions.iter().enumerate() {
        assert_eq!((run.ranges[k][0], run.anchor_ranges[k], run.external_positions[k]), (1.0 - x, -x, *x));
    }
}

#[test]
fn noise_is_in_proportion_to_motion_and_distance() {
    let params = MonobotParams { n_landmarks: 3, n_steps: 1000, ..MonobotParams::default() };
    let (mut motion, mut range, mut anchor, mut external) = (vec![], vec![], vec![], vec![]);
    for run in runs(params, 40) {
        for k in 0..run.controls.len() {
            let u = run.controls[k];
            motion.push((run.positions[k + 1] - run.positions[k] - u) / u.abs());
            let x = run.positions[k];
            range.extend(run.ranges[k].iter().map(|z| (z - (1.0 - x)) / (1.0 - x).abs()));
            anchor.push((run.anchor_ranges[k] + x) / x.abs());
            external.push(run.external_positions[k] - x);
        }
    }
    for (what, sigma, values) in [
        ("motion", 0.1, motion),
        ("range", 0.05, range),
        ("anchor", 0.05, anchor),
        ("external", 0.05, external),
    ] {
        let n = values.len() as f64;
        assert_near(what, mean(&values), 0.0, sigma / n.sqrt());
        assert_near(what, deviation(&values), sigma, sigma / (2.0 * n).sqrt());
    }
}

#[test]
fn as_a_log_it_says_the_same() {
    // A landmark that the robot passes: behind it, bearings are π.
    let params = MonobotParams { landmark_position_m: -1.2, n_landmarks: 2, ..MonobotParams::default() };
    let run = &runs(params, 1)[0];
    let records = run.records(Stamp::from_nanoseconds(0), 100);
    let mut looks = records.iter().filter_map(|r| match &r.data {
        RecordData::Detections(detections) => Some(detections),
        _ => None,
    });
    for ranges in &run.ranges {
        for (detection, range) in looks.next().expect("a look for every position").iter().zip(ranges) {
            assert_abs_diff_eq!(detection.range * libm::cos(detection.bearing), range, epsilon = 1e-12);
        }
    }
    let travelled: f64 = records
        .iter()
        .filter_map(|r| match r.data {
            RecordData::OdometryIncrement(step) => Some(step.x()),
            _ => None,
        })
        .sum();
    assert_abs_diff_eq!(travelled, run.controls.iter().sum::<f64>(), epsilon = 1e-12);
}
