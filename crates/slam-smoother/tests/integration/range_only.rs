//! Laws of the residuals, recovery of a simulated world, and hostile input.

#![allow(
    clippy::unwrap_used,
    clippy::expect_used,
    clippy::panic,
    reason = "a panic is the verdict of a test, in its helpers too"
)]

use approx::assert_abs_diff_eq;
use nalgebra::{Matrix2, Vector2};
use rand::SeedableRng;
use rand_chacha::ChaCha8Rng;
use rand_distr::{Distribution, Normal};
use wayfix_estimation_traits::{LieGroup, Pose2};
use wayfix_slam_smoother::{
    SlamSmootherError,
    range_only::{BeaconRange, Range, RangeOnlyEstimate, RangeOnlyInput, RangeOnlyParams, estimate},
};
use wayfix_smoother::laws;

const BEACONS: [(u32, [f64; 2]); 3] = [(2, [-12.0, 9.0]), (5, [20.0, -7.0]), (9, [6.0, 25.0])];
const RANGE_SIGMA: f64 = 0.3;
const SCALE: f64 = 1.05;
const BIAS: f64 = 1.5;

/// A drive of 600 steps, curved unless `is_straight`; every beacon is heard in turn, and each `outlier`th range is 20 m too long.
fn drive(is_straight: bool, outlier: usize) -> (RangeOnlyInput, Vec<Pose2<f64>>) {
    let mut rng = ChaCha8Rng::seed_from_u64(7);
    let mut noise = |sigma: f64| Normal::new(0.0, sigma).unwrap().sample(&mut rng);
    let start = Pose2::new(0.0, 0.0, 0.3);
    let (mut truth, mut motions, mut ranges) = (vec![start], Vec::new(), Vec::new());
    for k in 0..600 {
        let turn = if is_straight { 0.0 } else { 0.06 * (k as f64 / 90.0).sin() };
        let motion = Pose2::new(0.25, 0.0, turn);
        truth.push(truth[k].compose(&motion));
        let error = if is_straight { [0.0; 3] } else { [noise(0.02), noise(0.02), noise(0.004)] };
        motions.push(motion.compose(&Pose2::exp(&error.into())));
        let (beacon, [x, y]) = BEACONS[k % 3];
        let distance = (Vector2::new(x, y) - truth[k + 1].translation).norm();
        let too_long = if outlier > 0 && k % outlier == 0 { 20.0 } else { 0.0 };
        let range = SCALE * distance + BIAS + noise(RANGE_SIGMA) + too_long;
        ranges.push(Range { pose: k + 1, beacon, range });
    }
    (RangeOnlyInput { start, motions, ranges }, truth)
}

#[test]
fn range_residual_keeps_the_laws() {
    for heading in [0.0, 1e-8, 3.1, -3.1] {
        for beacon in [[4.0, -1.0], [1.0, 2.5], [-300.0, 20.0]] {
            let at = (&Pose2::new(1.0, 2.0, heading), &Vector2::from(beacon), &Vector2::new(-0.7, 0.06));
            laws::residual(&BeaconRange { range: 5.0 }, at).unwrap();
        }
    }
}

/// Variance of a place by what may be wrong with odometry throughout: here nothing is.
fn of_odometry(found: &RangeOnlyEstimate, place: Vector2<f64>) -> f64 {
    (found.odometry_error_sigma * (place - found.poses[0].translation).norm()).powi(2)
}

#[test]
fn path_beacons_and_calibration_are_found() {
    for outlier in [0, 10] {
        let (input, truth) = drive(false, outlier);
        let found = estimate(&input, &RangeOnlyParams::default()).unwrap();
        assert!(found.unplaced.is_empty());
        // Errors within five standard deviations by the estimate's own covariance: 1e-6 for Gaussian errors.
        for (id, [x, y]) in BEACONS {
            let (place, mut covariance) = found.beacons[&id];
            covariance -= Matrix2::identity() * of_odometry(&found, place);
            let error = Vector2::new(x, y) - place;
            let nees = error.dot(&covariance.cholesky().unwrap().solve(&error));
            assert!(nees < 28.0, "beacon {id}: {error} {nees}");
        }
        // Not the first poses: ranges of 0.3 m in 150 m hardly tell the noise of a single step.
        for (number, covariance) in found.pose_covariances.iter().skip(50).step_by(50) {
            let error = found.poses[*number].inverse().compose(&truth[*number]).log();
            let mut covariance = *covariance;
            let of_odometry = of_odometry(&found, found.poses[*number].translation);
            covariance.m11 -= of_odometry;
            covariance.m22 -= of_odometry;
            let nees = error.dot(&covariance.cholesky().unwrap().solve(&error));
            assert!(nees < 34.0, "pose {number}: {error} {nees}");
        }
        assert_abs_diff_eq!(found.calibration.bias, BIAS, epsilon = 5.0 * found.calibration_sigma.bias);
        assert_abs_diff_eq!(
            found.calibration.log_scale,
            SCALE.ln(),
            epsilon = 5.0 * found.calibration_sigma.log_scale
        );
        // Within a factor of 1.5, as noise from a log has to be.
        assert!((found.range_sigma / RANGE_SIGMA).ln().abs() < 1.5_f64.ln(), "{}", found.range_sigma);
        assert_eq!(found.n_outliers > 50, outlier > 0, "{}", found.n_outliers);
    }
}

/// Odometry that is too long and drives askew fits as well: the map is scaled and turned, headings are not, and only the covariances know.
#[test]
fn no_range_tells_scale_and_direction_of_odometry() {
    let (input, _) = drive(false, 0);
    let (angle, scale) = (0.02, 1.03);
    let turn = Pose2::new(0.0, 0.0, angle);
    let mut wrong = input.clone();
    for motion in &mut wrong.motions {
        motion.translation = turn.transform(&motion.translation) * scale;
    }
    let [right, wrong] = [input, wrong].map(|input| estimate(&input, &RangeOnlyParams::default()).unwrap());
    let change = wrong.calibration.log_scale - right.calibration.log_scale;
    assert_abs_diff_eq!(change, -scale.ln(), epsilon = 1e-3);
    let start = right.poses[0].translation;
    let mut n_far = 0;
    for (number, covariance) in right.pose_covariances.iter().skip(50).step_by(50) {
        let (a, b) = (right.poses[*number], wrong.poses[*number]);
        let moved = start + turn.transform(&(a.translation - start)) * scale;
        assert!((moved - b.translation).norm() < 0.02, "pose {number}: {moved} {}", b.translation);
        assert_abs_diff_eq!(a.heading(), b.heading(), epsilon = 2e-3);
        let error = a.inverse().compose(&b).translation;
        let of_place = covariance.fixed_view::<2, 2>(0, 0).into_owned();
        let nees = error.dot(&of_place.cholesky().unwrap().solve(&error));
        // Chi-square with two degrees of freedom, 95 %.
        assert!(nees < 5.99, "pose {number}: {nees}");
        n_far += usize::from(error.norm() > RANGE_SIGMA);
    }
    assert!(n_far > 3, "{n_far}");
}

#[test]
fn equal_input_gives_equal_bits() {
    let (input, _) = drive(false, 0);
    let [a, b] = [(), ()].map(|()| estimate(&input, &RangeOnlyParams::default()).unwrap());
    assert_eq!(a.poses, b.poses);
    assert_eq!(a.noise, b.noise);
}

#[test]
fn straight_path_leaves_both_sides_and_is_refused() {
    let (input, _) = drive(true, 0);
    let error = estimate(&input, &RangeOnlyParams::default()).unwrap_err();
    assert!(matches!(error, SlamSmootherError::NoBeacon { n_beacons: 3, n_ranges: 600, .. }), "{error}");
}

#[test]
fn beacon_with_few_ranges_is_left_out_and_named() {
    let (mut input, _) = drive(false, 0);
    input.ranges.extend((0..3).map(|k| Range { pose: 40 * k, beacon: 77, range: 9.0 }));
    let found = estimate(&input, &RangeOnlyParams::default()).unwrap();
    assert_eq!(found.beacons.len(), 3);
    assert_eq!((found.unplaced[0].beacon, found.unplaced[0].n_ranges, found.n_ranges), (77, 3, 600));
}

#[test]
fn one_beacon_alone_is_placed_or_refused() {
    let (mut input, _) = drive(false, 0);
    input.ranges.retain(|range| range.beacon == 5);
    match estimate(&input, &RangeOnlyParams::default()) {
        Ok(found) => assert!((found.beacons[&5].0 - Vector2::new(20.0, -7.0)).norm() < 3.0),
        Err(error) => assert!(matches!(error, SlamSmootherError::NoBeacon { .. }), "{error}"),
    }
}

#[test]
fn numbers_that_are_none_are_refused_by_place() {
    let (input, _) = drive(false, 0);
    for bad in [f64::NAN, f64::INFINITY, 0.0, -1.0] {
        let mut input = input.clone();
        input.ranges[17].range = bad;
        let error = estimate(&input, &RangeOnlyParams::default()).unwrap_err();
        assert!(matches!(error, SlamSmootherError::OutOfRange { what: "range", index: 17, .. }), "{error}");
    }
    let mut unknown = input.clone();
    unknown.ranges[3].pose = 601;
    let error = estimate(&unknown, &RangeOnlyParams::default()).unwrap_err();
    assert!(matches!(error, SlamSmootherError::UnknownPose { index: 3, pose: 601, n_poses: 601 }), "{error}");
    let mut broken = input;
    broken.motions[5] = Pose2::new(f64::NAN, 0.0, 0.0);
    assert!(estimate(&broken, &RangeOnlyParams::default()).is_err());
    let empty = RangeOnlyInput { start: Pose2::identity(), motions: Vec::new(), ranges: Vec::new() };
    assert!(matches!(
        estimate(&empty, &RangeOnlyParams::default()),
        Err(SlamSmootherError::NoBeacon { n_beacons: 0, .. })
    ));
}
