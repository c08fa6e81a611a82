//! The iterated update: a minimum it reaches, a refusal that says how far it came, and a state that is better than one linearization.
#![allow(clippy::unwrap_used, clippy::panic, reason = "a test that cannot build its models has failed")]

use approx::assert_abs_diff_eq;
use nalgebra::{Matrix1, Matrix2, Matrix3, Vector1, Vector2, Vector3};
use wayfix_estimation_traits::{Angle, Manifold, MotionModel, Pose2, SensorModel};
use wayfix_gaussian_core::{ChiSquaredGate, Gaussian};
use wayfix_kalman::{
    ExtendedKalmanAlgorithm, GatedUpdate, GaussianFilter, IteratedExtendedKalmanAlgorithm, KalmanAlgorithm,
    KalmanError, SquareRootKalmanAlgorithm, UnscentedKalmanAlgorithm,
};

struct Still;
impl MotionModel for Still {
    type State = Pose2<f64>;
    type Control = ();
    fn propagate(&self, pose: &Pose2<f64>, (): &()) -> Pose2<f64> {
        *pose
    }
    fn noise(&self, _: &Pose2<f64>, (): &()) -> Matrix3<f64> {
        Matrix3::zeros()
    }
}

/// The bearing of a landmark in the body frame.
struct Bearing(Vector2<f64>);
impl SensorModel for Bearing {
    type State = Pose2<f64>;
    type Measurement = Angle<f64>;
    fn expected(&self, pose: &Pose2<f64>) -> Angle<f64> {
        let seen = pose.inverse_transform(&self.0);
        Angle::new(seen.y.atan2(seen.x))
    }
    fn noise(&self, _: &Pose2<f64>) -> Matrix1<f64> {
        Matrix1::new(1e-4)
    }
}

fn prior() -> Gaussian<Pose2<f64>> {
    Gaussian::from_sigmas(Pose2::new(0.5, -0.4, 3.0), &Vector3::new(0.5, 0.5, 0.3)).unwrap()
}

/// What the update minimises: squared distance to the prior and to the measurement, in their own units.
fn cost(pose: &Pose2<f64>, sensor: &Bearing, z: &Angle<f64>) -> f64 {
    let from_prior = prior().mahalanobis_squared(pose).unwrap();
    let residual = sensor.expected(pose).local(z)[0];
    from_prior + residual * residual / 1e-4
}

#[test]
fn the_result_is_a_minimum_of_the_cost() {
    let sensor = Bearing(Vector2::new(-1.5, 0.8));
    let z = Angle::new(0.4);
    let mut filter = GaussianFilter::new(Still, IteratedExtendedKalmanAlgorithm::default(), prior()).unwrap();
    filter.update(&sensor, &z).unwrap();
    let best = *filter.estimate().mean();
    let lowest = cost(&best, &sensor, &z);
    // Settled to 1e-6 sigma: ten times that in any direction can only be uphill.
    for axis in 0..3 {
        for sign in [-1.0, 1.0] {
            let mut step = Vector3::zeros();
            step[axis] = sign * 1e-3 * filter.estimate().sigmas()[axis];
            assert!(cost(&best.retract(&step), &sensor, &z) > lowest, "downhill along axis {axis}");
        }
    }
    let mut once = GaussianFilter::new(Still, ExtendedKalmanAlgorithm, prior()).unwrap();
    once.update(&sensor, &z).unwrap();
    assert!(cost(once.estimate().mean(), &sensor, &z) > lowest);
}

/// A sensor whose slope misleads Gauss-Newton at first: from 2 it overshoots to −3.5, from there to 14.
struct ArcTangent;
impl SensorModel for ArcTangent {
    type State = Vector1<f64>;
    type Measurement = Vector1<f64>;
    fn expected(&self, state: &Vector1<f64>) -> Vector1<f64> {
        Vector1::new(state[0].atan())
    }
    fn jacobian(&self, state: &Vector1<f64>) -> Matrix1<f64> {
        Matrix1::new(1.0 / (1.0 + state[0] * state[0]))
    }
    fn noise(&self, _: &Vector1<f64>) -> Matrix1<f64> {
        Matrix1::new(1e-8)
    }
}

#[test]
fn no_convergence_returns_last_estimate_and_keeps_the_filter() {
    let motion = wayfix_kalman::LinearMotion::stationary(Matrix1::new(0.0)).unwrap();
    let prior = Gaussian::new(Vector1::new(2.0), Matrix1::new(100.0)).unwrap();
    let hasty = IteratedExtendedKalmanAlgorithm { max_iterations: 2, ..Default::default() };
    let mut filter = GaussianFilter::new(motion, hasty, prior.clone()).unwrap();
    match filter.update(&ArcTangent, &Vector1::new(0.0)) {
        Err(KalmanError::NotConverged { iterations, last_step, last_offset }) => {
            assert_eq!((iterations, last_offset.len()), (2, 1));
            // x - (1 + x²) atan x, twice from 2; the prior of sigma 10 hardly pulls against a sensor of sigma 1e-4.
            let newton = |x: f64| x - (1.0 + x * x) * x.atan();
            let newton_twice = newton(newton(2.0));
            assert_abs_diff_eq!(2.0 + last_offset[0], newton_twice, epsilon = 1e-2 * newton_twice);
            assert!(last_step > 1e-6);
        }
        other => panic!("expected no convergence, got {other:?}"),
    }
    assert_eq!(filter.estimate(), prior);
}

#[test]
fn a_gate_rejects_visibly_in_every_form() {
    fn rejects<F: KalmanAlgorithm<Pose2<f64>>>(form: F) {
        let gate = ChiSquaredGate::from_probability(1, 0.99).unwrap();
        let sensor = Bearing(Vector2::new(-9.5, 0.8));
        let mut filter = GaussianFilter::new(Still, form, prior()).unwrap();
        let before = filter.estimate();
        match filter.update_gated(&sensor, Some(&Angle::new(2.5)), &gate).unwrap() {
            GatedUpdate::Rejected { innovation, threshold } => {
                assert!(innovation.nis() > threshold);
                assert_eq!(threshold, gate.threshold());
            }
            other => panic!("2.5 rad of 0.3 expected, yet {other:?}"),
        }
        assert_eq!(filter.estimate(), before);
        assert!(matches!(filter.update_gated(&sensor, None, &gate).unwrap(), GatedUpdate::Missing));
        assert!(
            filter.update_gated(&sensor, Some(&sensor.expected(before.mean())), &gate).unwrap().is_accepted()
        );
    }
    rejects(ExtendedKalmanAlgorithm);
    rejects(IteratedExtendedKalmanAlgorithm::default());
    rejects(UnscentedKalmanAlgorithm::default());
    rejects(SquareRootKalmanAlgorithm);
}

/// Turning the body frame turns the covariance with it: seen from the world, a heading correction must not move position uncertainty.
#[test]
fn a_corrected_heading_carries_the_covariance_along() {
    struct Compass;
    impl SensorModel for Compass {
        type State = Pose2<f64>;
        type Measurement = Angle<f64>;
        fn expected(&self, pose: &Pose2<f64>) -> Angle<f64> {
            pose.rotation
        }
        fn noise(&self, _: &Pose2<f64>) -> Matrix1<f64> {
            Matrix1::new(1e-6)
        }
    }
    fn world(gaussian: &Gaussian<Pose2<f64>>) -> Matrix2<f64> {
        let turn = gaussian.mean().rotation_matrix();
        turn * gaussian.covariance().fixed_view::<2, 2>(0, 0) * turn.transpose()
    }
    fn keeps<F: KalmanAlgorithm<Pose2<f64>>>(form: F) {
        let prior = Gaussian::from_sigmas(Pose2::new(0.0, 0.0, 0.0), &Vector3::new(1.0, 0.1, 0.5)).unwrap();
        let before = world(&prior);
        let mut filter = GaussianFilter::new(Still, form, prior).unwrap();
        filter.update(&Compass, &Angle::new(0.8)).unwrap();
        // Position and heading are independent here, so the world sees no change but rounding and numerical differencing (1e-9).
        assert_abs_diff_eq!(world(&filter.estimate()), before, epsilon = 1e-8);
    }
    keeps(ExtendedKalmanAlgorithm);
    keeps(IteratedExtendedKalmanAlgorithm::default());
    keeps(SquareRootKalmanAlgorithm);
    keeps(UnscentedKalmanAlgorithm::default());
    keeps(wayfix_kalman::InformationFilterAlgorithm);
    keeps(wayfix_kalman::SequentialUpdateAlgorithm);
}
