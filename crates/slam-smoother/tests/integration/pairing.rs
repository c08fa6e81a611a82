//! Pairings that the smoother takes back while they are in its window.

#![allow(
    clippy::unwrap_used,
    clippy::expect_used,
    clippy::panic,
    reason = "a panic is the verdict of a test, in its helpers too"
)]

use nalgebra::Matrix2;
use wayfix_estimation_traits::{LieGroup, Manifold, Pose2};
use wayfix_slam_smoother::points::{Detection, PointSmoother, PointSmootherParams, SettledPose};

use crate::circle::{Step, params, start, steps, take};

/// The detections of some steps have the landmarks that `pair` gives them.
fn with_pairings(mut steps: Vec<Step>, pair: impl Fn(usize, u32) -> u32) -> Vec<Step> {
    for (k, step) in steps.iter_mut().enumerate() {
        step.seen.iter_mut().for_each(|(landmark, _)| *landmark = pair(k, *landmark));
    }
    steps
}

fn run_with_own_pairings(steps: &[Step], pairs_anew: bool) -> (PointSmoother, Vec<SettledPose>) {
    let params = PointSmootherParams { pairs_anew, ..params(Some(20.0)) };
    let mut smoother = PointSmoother::new(params, &start()).unwrap();
    let mut settled = Vec::new();
    for (k, step) in steps.iter().enumerate() {
        settled.extend(take(&mut smoother, k, step));
    }
    settled.extend(smoother.finish().unwrap());
    (smoother, settled)
}

fn largest_difference(a: &[SettledPose], b: &[SettledPose]) -> f64 {
    assert_eq!(a.len(), b.len());
    a.iter().zip(b).map(|(a, b)| a.pose.local(&b.pose).norm()).fold(0.0, f64::max)
}

#[test]
fn wrong_pairings_in_the_window_are_taken_back() {
    // Landmarks 1 and 4, seen in one scan, are exchanged in three scans.
    let exchange = |k: usize, landmark: u32| match (k, landmark) {
        (32 | 35 | 38, 1) => 4,
        (32 | 35 | 38, 4) => 1,
        _ => landmark,
    };
    let right = run_with_own_pairings(&steps(80).0, true);
    let wrong = with_pairings(steps(80).0, exchange);
    assert_eq!(right.0.n_paired_anew(), 0);
    let (anew, kept) = (run_with_own_pairings(&wrong, true), run_with_own_pairings(&wrong, false));
    assert_eq!((anew.0.n_paired_anew(), kept.0.n_paired_anew()), (6, 0));
    let (by_anew, by_kept) = (largest_difference(&right.1, &anew.1), largest_difference(&right.1, &kept.1));
    // ONLINE ends its iterations at 1e-6 of the cost: a thousandth of σ² at costs of some hundred.
    assert!(by_anew < 1e-3 && by_kept > 10.0 * by_anew, "{by_anew} m, {by_kept} m with the pairings kept");
}

#[test]
fn landmark_without_detections_leaves_the_map() {
    // The robot stands before two landmarks 0.2 m apart, 2.5 σ of a bearing. For 99, one scan has the left one and one the right one.
    let detection = |y: f64, error: f64| {
        let (range, bearing) = (f64::hypot(4.0, y), y.atan2(4.0) + error);
        Detection { range, bearing, covariance: Matrix2::new(0.0025, 0.0, 0.0, 0.0004) }
    };
    let (left, right) = ((1, detection(0.1, 0.0)), (2, detection(-0.1, 0.0)));
    let params = PointSmootherParams { mount: Pose2::identity(), pairs_anew: true, ..params(Some(20.0)) };
    let mut smoother = PointSmoother::new(params, &start()).unwrap();
    for k in 0..10 {
        let seen = match k {
            5 => vec![(99, detection(0.1, 0.005)), right],
            6 => vec![left, (99, detection(-0.1, 0.0))],
            _ => vec![left, right],
        };
        take(&mut smoother, k, &Step { motion: Pose2::identity(), seen });
        assert_eq!(smoother.contains(99), k == 5, "at scan {k}");
    }
    smoother.finish().unwrap();
    assert_eq!((smoother.n_paired_anew(), smoother.landmarks().len()), (2, 2));
}
