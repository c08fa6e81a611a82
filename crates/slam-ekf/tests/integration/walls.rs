//! Walls as landmarks: a lap around a free-standing wall in a hall, which is seen from both sides, with normals across the wrap of angles.
#![cfg(feature = "lines")]
#![allow(clippy::unwrap_used, reason = "a test that cannot build its filter has failed")]

use crate::common;

use std::f64::consts::PI;

use approx::{abs_diff_eq, assert_abs_diff_eq};
use nalgebra::{Matrix2, Vector2};
use rand::SeedableRng;
use rand_chacha::ChaCha8Rng;
use wayfix_estimation_traits::{LieGroup, Manifold, Pose2};
use wayfix_gaussian_core::ChiSquaredBand;
use wayfix_slam_ekf::{
    EkfSlam, JointCompatibility, JointCompatibilityParams, LinearizationPoint, Observation, OdometryMotion,
    SlamParams, Wall, WallLine, WallMeasurement, WallSensor,
};

const N_STEPS: usize = 120;
const ODOMETRY: [f64; 2] = [0.02, 0.01];
/// m at either end of what is seen of a wall.
const END_SIGMA: f64 = 0.01;

/// A hall of 12 × 10 m around the origin, and a wall of 3 m in the middle of it.
fn walls() -> Vec<[Vector2<f64>; 2]> {
    let corners = [(6.0, 5.0), (-6.0, 5.0), (-6.0, -5.0), (6.0, -5.0)].map(|(x, y)| Vector2::new(x, y));
    let sides = (0..4).map(|i| [corners[i], corners[(i + 1) % 4]]);
    sides.chain([[Vector2::new(-1.5, 0.0), Vector2::new(1.5, 0.0)]]).collect()
}

fn through([a, b]: [Vector2<f64>; 2]) -> WallLine {
    let along = (b - a).normalize();
    let normal = Vector2::new(along.y, -along.x);
    WallLine::new(normal.dot(&a), normal.y.atan2(normal.x))
}

/// What the points of a wall give: noise across it at both ends, and the covariance that this means for its line.
fn look(robot: &Pose2<f64>, ends: &[Vector2<f64>; 2], rng: &mut ChaCha8Rng) -> Observation<WallMeasurement> {
    let seen = ends.map(|end| robot.inverse_transform(&end));
    let along = (seen[1] - seen[0]).normalize();
    let across = Vector2::new(along.y, -along.x);
    let noisy = seen.map(|end| end + across * END_SIGMA * common::normal(rng));
    // Half of the scans give the line in its other form, which is the same line with the other sign of the correlation.
    let line = through(noisy);
    let line = if common::normal(rng) > 0.0 { line } else { WallLine::new(-line.rho, line.alpha + PI) };
    let [a, b] = noisy.map(|end| line.along(&end));
    // ρ + (s - s_end) dα = error at either end, for the two ends.
    let by_line = Matrix2::new(1.0, a, 1.0, b).try_inverse().unwrap();
    let covariance = by_line * by_line.transpose() * END_SIGMA * END_SIGMA;
    Observation { label: None, measurement: WallMeasurement { line, covariance, ends: noisy } }
}

fn lap(seed: u64, linearization: LinearizationPoint) -> (EkfSlam<WallSensor>, Pose2<f64>) {
    lap_at(&Pose2::new(0.0, 0.0, 0.0), seed, linearization)
}

/// The lap in a world that is moved by `place`.
fn lap_at(
    place: &Pose2<f64>,
    seed: u64,
    linearization: LinearizationPoint,
) -> (EkfSlam<WallSensor>, Pose2<f64>) {
    let walls = walls().into_iter().map(|ends| ends.map(|end| place.transform(&end)));
    let walls: Vec<[Vector2<f64>; 2]> = walls.collect();
    let mut rng = ChaCha8Rng::seed_from_u64(seed);
    let motion = OdometryMotion {
        translation_variance_per_meter: 0.0,
        heading_variance_per_meter: 0.0,
        heading_variance_per_radian: 0.0,
        translation_variance_per_step: ODOMETRY[0].powi(2),
        heading_variance_per_step: ODOMETRY[1].powi(2),
    };
    let sensor = WallSensor { rho_sigma: 1e-6, alpha_sigma: 1e-6, ..WallSensor::default() };
    let mut rule = JointCompatibility::new(JointCompatibilityParams::default()).unwrap();
    let mut truth = place.compose(&Pose2::new(3.0, 0.5, std::f64::consts::FRAC_PI_2));
    let mut slam = EkfSlam::new(
        sensor,
        SlamParams { linearization_point: linearization, ..SlamParams::default() },
        truth,
    )
    .unwrap();
    let turn = std::f64::consts::TAU / N_STEPS as f64;
    for _ in 0..N_STEPS {
        let step = Pose2::new(3.0 * turn, 0.0, turn);
        truth = truth.compose(&step);
        let [x, y] = [0, 1].map(|_| ODOMETRY[0] * common::normal(&mut rng));
        let heading = step.heading() + ODOMETRY[1] * common::normal(&mut rng);
        slam.predict(&motion, &Pose2::new(step.x() + x, step.y() + y, heading)).unwrap();
        let observations: Vec<_> = walls.iter().map(|ends| look(&truth, ends, &mut rng)).collect();
        slam.update(&observations, &mut rule).unwrap();
    }
    (slam, truth)
}

#[test]
fn every_wall_is_one_landmark_where_it_is_and_as_long_as_it_is() {
    let (slam, truth) = lap(1, LinearizationPoint::Newest);
    assert_eq!(slam.n_landmarks(), walls().len()); // the free-standing one was seen from both sides
    let error = slam.robot().local(&truth);
    assert!(error.xy().norm() < 0.05 && error.z.abs() < 0.02, "{error}"); // five deviations of a look, odometry alone: 0.2 m
    for ends in walls() {
        let distance = |wall: &Wall| wall.world_line().local(&through(ends)).norm();
        let found =
            slam.landmarks().map(|estimate| estimate.mean).min_by(|a, b| distance(a).total_cmp(&distance(b)));
        let found = found.unwrap();
        let [from, to] = found.stretch;
        assert!(distance(&found) < 0.05, "{found:?} for {ends:?}");
        assert_abs_diff_eq!(to - from, (ends[1] - ends[0]).norm(), epsilon = 0.3);
    }
}

#[test]
fn the_filters_are_as_sure_as_they_should_be() {
    const N_RUNS: u64 = 50;
    let band = ChiSquaredBand::for_average(3, N_RUNS as usize, 0.99).unwrap();
    for linearization in
        [LinearizationPoint::Newest, LinearizationPoint::FirstEstimates, LinearizationPoint::Invariant]
    {
        let nees = |seed| {
            let (slam, truth) = lap(seed, linearization);
            let error = slam.robot().local(&truth);
            error.dot(&slam.robot_covariance().cholesky().unwrap().solve(&error))
        };
        let mean = (0..N_RUNS).map(nees).sum::<f64>() / N_RUNS as f64;
        assert!(band.contains(mean), "{linearization:?}: {mean} outside {} to {}", band.low, band.high);
    }
}

#[test]
fn rigid_motion_of_the_world_changes_no_estimate() {
    for linearization in
        [LinearizationPoint::Newest, LinearizationPoint::FirstEstimates, LinearizationPoint::Invariant]
    {
        let (here, truth) = lap(1, linearization);
        for place in [Pose2::new(300.0, -200.0, 0.4), Pose2::new(0.0, 1e4, 2.0)] {
            let (there, true_there) = lap_at(&place, 1, linearization);
            assert_eq!(there.n_landmarks(), here.n_landmarks());
            let [error, moved] = [here.robot().local(&truth), there.robot().local(&true_there)];
            assert!(
                abs_diff_eq!(error, moved, epsilon = 1e-6),
                "{linearization:?} {place:?}: {error} {moved}"
            );
            let [covariance, moved] = [here.robot_covariance(), there.robot_covariance()];
            let change = (covariance - moved).norm() / covariance.norm();
            assert!(change < 1e-4, "{linearization:?} {place:?}: {change}");
        }
    }
}

#[test]
fn looks_that_are_no_walls_are_unusable_and_change_nothing() {
    let (mut slam, truth) = lap(2, LinearizationPoint::Newest);
    let good = look(&truth, &walls()[0], &mut ChaCha8Rng::seed_from_u64(3)).measurement;
    let mut rule = JointCompatibility::new(JointCompatibilityParams::default()).unwrap();
    let before = slam.snapshot();
    for bad in [
        WallMeasurement { line: WallLine { rho: f64::NAN, ..good.line }, ..good },
        WallMeasurement { line: WallLine { alpha: f64::INFINITY, ..good.line }, ..good },
        WallMeasurement { covariance: -good.covariance, ..good },
        WallMeasurement { covariance: good.covariance * f64::NAN, ..good },
        WallMeasurement { ends: [Vector2::new(f64::NAN, 0.0), good.ends[1]], ..good },
    ] {
        let report = slam.update(&[Observation { label: None, measurement: bad }], &mut rule).unwrap();
        assert!(matches!(report.outcomes[0], wayfix_slam_ekf::ObservationOutcome::Unusable), "{bad:?}");
        assert_eq!(slam.snapshot().covariance, before.covariance);
    }
}
