//! The laws of filters, for every form.
#![allow(clippy::unwrap_used, clippy::panic, reason = "a test that cannot build its models has failed")]

use approx::assert_abs_diff_eq;
use nalgebra::{Matrix1, Matrix3, Vector2, Vector3};
use wayfix_estimation_traits::{Angle, Manifold, MotionModel, Pose2, SensorModel, laws, numerical_jacobian};
use wayfix_gaussian_core::Gaussian;
use wayfix_kalman::{
    ExtendedKalmanAlgorithm, GaussianFilter, InformationFilterAlgorithm, IteratedExtendedKalmanAlgorithm,
    KalmanAlgorithm, SequentialUpdateAlgorithm, SquareRootKalmanAlgorithm, StackedMeasurement, StackedSensor,
    UnscentedKalmanAlgorithm,
};

/// Body-frame increments.
#[derive(Clone)]
struct Odometry;
impl MotionModel for Odometry {
    type State = Pose2<f64>;
    type Control = Vector3<f64>;
    fn propagate(&self, pose: &Pose2<f64>, step: &Vector3<f64>) -> Pose2<f64> {
        pose.retract(step)
    }
    fn jacobian(&self, _: &Pose2<f64>, step: &Vector3<f64>) -> Matrix3<f64> {
        let (sin, cos) = step.z.sin_cos();
        let turned = Vector2::new(-step.y, step.x);
        // R(δθ)ᵀ [I  J t]: the increment's end, seen from the turned body.
        Matrix3::new(
            cos,
            sin,
            cos * turned.x + sin * turned.y, //
            -sin,
            cos,
            -sin * turned.x + cos * turned.y, //
            0.0,
            0.0,
            1.0,
        )
    }
    fn noise(&self, _: &Pose2<f64>, _: &Vector3<f64>) -> Matrix3<f64> {
        Matrix3::from_diagonal(&Vector3::new(1e-4, 1e-4, 1e-4))
    }
}

/// The bearing of a landmark in the body frame.
#[derive(Clone)]
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

fn landmarks() -> StackedSensor<Bearing> {
    StackedSensor(
        [(4.0, 1.0), (-3.0, 5.0), (1.0, -6.0), (-5.0, -4.0)]
            .map(|(x, y)| Bearing(Vector2::new(x, y)))
            .to_vec(),
    )
}

fn prior() -> Gaussian<Pose2<f64>> {
    Gaussian::from_sigmas(Pose2::new(0.0, 0.0, 2.9), &Vector3::new(0.3, 0.3, 0.2)).unwrap()
}

fn moves<F: KalmanAlgorithm<Pose2<f64>>>(form: F) {
    let mut truth = Pose2::new(0.3, -0.2, 3.1);
    let before = prior().mean().local(&truth).norm();
    let mut filter = GaussianFilter::new(Odometry, form, prior()).unwrap();
    let step = Vector3::new(0.1, 0.0, 0.05);
    for k in 0..60 {
        truth = truth.retract(&step);
        filter.predict(&step).unwrap();
        if k % 4 != 3 {
            filter.update(&landmarks(), &landmarks().expected(&truth)).unwrap();
        }
    }
    let after = filter.estimate().mean().local(&truth).norm();
    // Four noise-free bearings pin a pose; a filter that does not move keeps its error of 0.4.
    assert!(before > 0.4 && after < 0.01, "from {before} to {after}");
}

#[test]
fn every_form_moves_to_the_truth() {
    moves(ExtendedKalmanAlgorithm);
    moves(IteratedExtendedKalmanAlgorithm::default());
    moves(SequentialUpdateAlgorithm);
    moves(SquareRootKalmanAlgorithm);
    moves(InformationFilterAlgorithm);
    moves(UnscentedKalmanAlgorithm::default());
}

/// The law suite: the bearings of one pose twenty times, and calls that a filter refuses.
fn obeys<F: KalmanAlgorithm<Pose2<f64>> + Clone>(form: F) {
    type Filter<F> = GaussianFilter<Odometry, F>;
    let truth = Pose2::new(0.3, -0.2, 3.1);
    let sees = |angles: Vec<Angle<f64>>| {
        move |filter: &mut Filter<F>| filter.update(&landmarks(), &StackedMeasurement(angles.clone())).is_ok()
    };
    let drives = |step: Vector3<f64>| move |filter: &mut Filter<F>| filter.predict(&step).is_ok();
    let good: laws::FilterLawCall<'_, Filter<F>> = &sees(landmarks().expected(&truth).0);
    let trial = laws::FilterLawTrial {
        estimate: &Filter::<F>::estimate,
        error: &|estimate: &Gaussian<Pose2<f64>>| estimate.mean().local(&truth).norm(),
        bound: 0.01,
        accepted: &[good; 20],
        refused: &[
            &sees(vec![Angle::new(f64::NAN); 4]),
            &sees(vec![Angle::new(0.0); 3]),
            &drives(Vector3::new(f64::NAN, 0.0, 0.0)),
            &drives(Vector3::new(0.0, f64::INFINITY, 0.0)),
        ],
    };
    laws::filter(&GaussianFilter::new(Odometry, form, prior()).unwrap(), &trial).unwrap();
}

#[test]
fn every_form_obeys_the_laws_of_filters() {
    obeys(ExtendedKalmanAlgorithm);
    obeys(IteratedExtendedKalmanAlgorithm::default());
    obeys(SequentialUpdateAlgorithm);
    obeys(SquareRootKalmanAlgorithm);
    obeys(InformationFilterAlgorithm);
    obeys(UnscentedKalmanAlgorithm::default());
}

#[test]
fn analytic_jacobians_are_the_numerical_ones() {
    for heading in [-3.1, -1.0, 0.0, 2.0, 3.1] {
        for step in [Vector3::new(0.3, -0.1, 0.2), Vector3::new(-0.2, 0.4, -1.3), Vector3::zeros()] {
            let pose = Pose2::new(1.0, -2.0, heading);
            let numerical = numerical_jacobian(|x: &Pose2<f64>| Odometry.propagate(x, &step), &pose);
            assert_abs_diff_eq!(Odometry.jacobian(&pose, &step), numerical, epsilon = 1e-8);
        }
    }
}
