//! Scales near both ends of the numbers, and noises that are symmetric to half the digits only: where a proof by bounds could prove too much.
#![allow(clippy::unwrap_used, reason = "a test that cannot build its models has failed")]

use approx::assert_abs_diff_eq;
use nalgebra::{DMatrix, DVector, Matrix2, Matrix2x3, Matrix3, Matrix4, Vector2, Vector3, Vector4};
use rand::{RngExt, SeedableRng};
use rand_chacha::ChaCha8Rng;
use wayfix_estimation_traits::SensorModel;
use wayfix_gaussian_core::Gaussian;
use wayfix_kalman::{
    ExtendedKalmanAlgorithm, GaussianFilter, Innovation, KalmanFilter, LinearMotion, LinearSensor,
};

/// Within the tolerance of `check_covariance`, the root of ε (1.49e-8) of the variances.
const LOPSIDED: f64 = 1.4e-8;

#[test]
fn an_innovation_of_any_scale_has_its_gain() {
    for exponent in [-300, -200, -160, -155, -150, 0, 140, 150, 155, 160, 300] {
        let covariance = Matrix2::new(2.0, 0.5, 0.5, 1.0) * 10f64.powi(exponent);
        let innovation =
            Innovation::<Vector2<f64>, Vector2<f64>>::new(Vector2::zeros(), covariance, covariance * 0.5)
                .unwrap();
        // The condition number is below 3; solving makes a few rounding errors of that size.
        let error = (innovation.gain() - Matrix2::identity() * 0.5).amax();
        assert!(error < 10.0 * f64::EPSILON, "1e{exponent}: {error:e}");
        let root = innovation.factor().l();
        assert_abs_diff_eq!(
            root * root.transpose(),
            covariance,
            epsilon = 10.0 * f64::EPSILON * covariance.amax()
        );
        // ln N(0; 0, S) = -ln 2π - ½ ln(1.75 s²).
        let expected = -std::f64::consts::TAU.ln() - 0.5 * 1.75_f64.ln() - f64::from(exponent) * 10_f64.ln();
        assert_abs_diff_eq!(innovation.log_likelihood(), expected, epsilon = 1e-13 * expected.abs().max(1.0));
    }
}

#[test]
fn variances_whose_product_overflows_keep_their_gains() {
    let covariance = Matrix2::from_diagonal(&Vector2::new(1e160, 1e170));
    let innovation =
        Innovation::<Vector2<f64>, Vector2<f64>>::new(Vector2::zeros(), covariance, covariance).unwrap();
    assert_abs_diff_eq!(innovation.gain(), Matrix2::identity(), epsilon = 4.0 * f64::EPSILON);
}

/// A sensor whose noise nobody mirrored.
struct Unchecked(Matrix2x3<f64>, Matrix2<f64>);
impl SensorModel for Unchecked {
    type State = Vector3<f64>;
    type Measurement = Vector2<f64>;
    fn expected(&self, state: &Vector3<f64>) -> Vector2<f64> {
        self.0 * state
    }
    fn jacobian(&self, _: &Vector3<f64>) -> Matrix2x3<f64> {
        self.0
    }
    fn noise(&self, _: &Vector3<f64>) -> Matrix2<f64> {
        self.1
    }
}

/// Two strong directions that the sensor sees and a weak one that it does not: an asymmetry of R must not leak into the weak one.
#[test]
fn a_lopsided_sensor_noise_leaves_the_belief_positive_definite() {
    let mut rng = ChaCha8Rng::seed_from_u64(3);
    for case in 0..4000 {
        let mut noise = Matrix2::identity();
        let entry = if case % 2 == 0 { (0, 1) } else { (1, 0) };
        noise[entry] = if case % 4 < 2 { LOPSIDED } else { -LOPSIDED };
        let axes = Matrix3::<f64>::from_fn(|_, _| rng.random_range(-1.0..1.0)).qr().q();
        let weak = 10_f64.powf(rng.random_range(-11.0..-8.0));
        let mut q = axes * Matrix3::from_diagonal(&Vector3::new(1.0, 1.0, weak)) * axes.transpose();
        q.fill_upper_triangle_with_lower_triangle();
        let motion = LinearMotion::new(Matrix3::identity() * 1e-3, q).unwrap();
        let sensed: Matrix2x3<f64> = axes.fixed_columns::<2>(0).transpose();
        let sensor = LinearSensor::new(sensed, noise).unwrap();
        let prior = Gaussian::new(Vector3::zeros(), Matrix3::identity() * 1e-9).unwrap();

        let mut linear = KalmanFilter::new(motion.clone(), prior.clone()).unwrap();
        linear.predict(None).unwrap();
        linear.update(&sensor, &Vector2::zeros()).unwrap();
        assert!(linear.estimate().covariance().cholesky().is_some(), "linear, case {case}");
        let mut extended = GaussianFilter::new(motion, ExtendedKalmanAlgorithm, prior).unwrap();
        extended.predict(&None).unwrap();
        extended.update(&Unchecked(sensed, noise), &Vector2::zeros()).unwrap();
    }
}

#[test]
fn ill_conditioned_motion_noise_keeps_positive_definiteness() {
    let n = 12;
    for asymmetry in [LOPSIDED / 3.0, LOPSIDED] {
        for weak in [1e-9, 1e-10, 1e-11, 1e-12] {
            // The averages of the triangles would be indefinite.
            let noise = DMatrix::from_fn(n, n, |i, j| {
                1.0 + if i == j { weak } else { 0.0 } + if i < j { asymmetry } else { 0.0 }
            });
            let motion = LinearMotion::new(DMatrix::identity(n, n) * 1e-9, noise).unwrap();
            let prior = Gaussian::new(DVector::zeros(n), DMatrix::identity(n, n) * 1e-9).unwrap();
            let mut filter = KalmanFilter::new(motion, prior).unwrap();
            let refused = filter.predict(None).is_err();
            assert!(refused || filter.estimate().covariance().clone().cholesky().is_some(), "{weak:e}");
        }
    }
}

/// The squares of this transition vanish, its products with the prior do not, and they are singular.
#[test]
fn squares_that_underflow_prove_nothing() {
    let mut rng = ChaCha8Rng::seed_from_u64(4);
    for floor in [1e-58, 1e-60, 1e-100] {
        for case in 0..200 {
            let column = Vector4::<f64>::from_fn(|_, _| rng.random_range(-1e-170..1e-170));
            let transition = column * nalgebra::RowVector4::new(1.0, 0.0, 0.0, 0.0);
            let motion = LinearMotion::new(transition, Matrix4::identity() * floor).unwrap();
            let prior = Gaussian::new(Vector4::zeros(), Matrix4::identity() * 1e300).unwrap();
            let mut filter = KalmanFilter::new(motion, prior).unwrap();
            let refused = filter.predict(None).is_err();
            assert!(refused || filter.estimate().covariance().cholesky().is_some(), "{floor:e}, case {case}");
        }
    }
}

#[test]
fn an_unchecked_prior_is_checked_by_the_filter() {
    let motion = |n| LinearMotion::stationary(DMatrix::identity(n, n)).unwrap();
    let narrow = Gaussian::from_parts_unchecked(DVector::zeros(3), DMatrix::<f64>::identity(2, 2));
    assert!(KalmanFilter::new(motion(3), narrow).is_err());
    let mut lopsided = DMatrix::<f64>::identity(2, 2);
    lopsided[(0, 1)] = f64::NAN;
    let mut filter =
        KalmanFilter::new(motion(2), Gaussian::from_parts_unchecked(DVector::zeros(2), lopsided)).unwrap();
    filter.predict(None).unwrap();
    assert_eq!(*filter.estimate().covariance(), DMatrix::identity(2, 2) * 2.0);
}
