//! On linear Gaussian problems every form is the Kalman filter, up to rounding.
#![allow(clippy::unwrap_used, clippy::panic, reason = "a test that cannot build its models has failed")]

use crate::common;

use crate::common::{constant_velocity, dynamic, position_sensor, track_prior};
use approx::{abs_diff_eq, assert_abs_diff_eq};
use nalgebra::{DMatrix, DVector, Matrix2, Matrix2x4, Vector2, Vector4};
use wayfix_estimation_traits::Manifold;
use wayfix_gaussian_core::Gaussian;
use wayfix_kalman::{
    ExtendedKalmanAlgorithm, GaussianFilter, InformationFilterAlgorithm, IteratedExtendedKalmanAlgorithm,
    KalmanAlgorithm, KalmanFilter, LinearMotion, LinearSensor, SequentialUpdateAlgorithm,
    SquareRootKalmanAlgorithm, UnscentedKalmanAlgorithm,
};

const STEPS: usize = 200;

/// A measurement every step but every seventh, with correlated noise.
fn measurement(k: usize) -> Option<Vector2<f64>> {
    let t = k as f64 * 0.1;
    (!k.is_multiple_of(7)).then(|| Vector2::new(t.sin() + 0.3 * (7.0 * t).cos(), 2.0 * t - (5.0 * t).sin()))
}

fn correlated_sensor() -> common::TrackSensor<f64> {
    let h = Matrix2x4::new(1.0, 0.2, 0.0, 0.1, 0.0, 1.0, 0.3, 0.0);
    LinearSensor::new(h, Matrix2::new(0.5, 0.3, 0.3, 0.4)).unwrap()
}

fn reference() -> (Vec<Gaussian<Vector4<f64>>>, Vec<f64>) {
    let mut filter = KalmanFilter::new(constant_velocity(0.5), track_prior(10.0)).unwrap();
    let sensor = correlated_sensor();
    let (mut estimates, mut likelihoods) = (vec![], vec![]);
    for k in 1..=STEPS {
        filter.predict(None).unwrap();
        if let Some(z) = measurement(k) {
            likelihoods.push(filter.update(&sensor, &z).unwrap().log_likelihood());
        }
        estimates.push(filter.estimate().clone());
    }
    (estimates, likelihoods)
}

/// Conditioning of this problem is below 1e3 and errors do not build up (the filter forgets), so 1e-12 is some 5 rounding errors of the
/// largest intermediate.
const ROUNDING: f64 = 1e-12;

fn agrees<F: KalmanAlgorithm<Vector4<f64>>>(form: F) {
    let (expected, likelihoods) = reference();
    let mut likelihoods = likelihoods.into_iter();
    let mut filter = GaussianFilter::new(constant_velocity(0.5), form, track_prior(10.0)).unwrap();
    let sensor = correlated_sensor();
    for (k, expected) in (1..=STEPS).zip(&expected) {
        filter.predict(&None).unwrap();
        if let Some(z) = measurement(k) {
            let innovation = filter.update(&sensor, &z).unwrap();
            let reference = likelihoods.next().unwrap();
            assert_abs_diff_eq!(
                innovation.log_likelihood(),
                reference,
                epsilon = ROUNDING * reference.abs().max(1.0)
            );
        }
        let estimate = filter.estimate();
        let scale = expected.covariance().norm();
        assert!(
            abs_diff_eq!(
                estimate.mean(),
                expected.mean(),
                epsilon = ROUNDING * expected.mean().norm().max(1.0)
            ),
            "mean at step {k}: {} against {}",
            estimate.mean(),
            expected.mean()
        );
        assert!(
            abs_diff_eq!(estimate.covariance(), expected.covariance(), epsilon = ROUNDING * scale),
            "covariance at {k}"
        );
    }
}

#[test]
fn the_extended_form_is_the_kalman_filter() {
    agrees(ExtendedKalmanAlgorithm);
}
#[test]
fn the_plain_form_is_the_kalman_filter() {}
#[test]
fn the_iterated_form_is_the_kalman_filter() {
    agrees(IteratedExtendedKalmanAlgorithm::default());
}
#[test]
fn the_sequential_form_is_the_kalman_filter() {
    agrees(SequentialUpdateAlgorithm);
}
#[test]
fn the_square_root_form_is_the_kalman_filter() {
    agrees(SquareRootKalmanAlgorithm);
}
#[test]
fn the_information_form_is_the_kalman_filter() {
    agrees(InformationFilterAlgorithm);
}
#[test]
fn the_unscented_form_is_the_kalman_filter() {
    agrees(UnscentedKalmanAlgorithm::default());
}

#[test]
fn the_plain_update_is_the_update() {
    let mut filter = KalmanFilter::new(constant_velocity(0.5), track_prior(10.0)).unwrap();
    let sensor = correlated_sensor();
    let (expected, _) = reference();
    for (k, expected) in (1..=STEPS).zip(&expected) {
        filter.predict(None).unwrap();
        if let Some(z) = measurement(k) {
            filter.update_plain(&sensor, &z).unwrap();
        }
        assert_abs_diff_eq!(
            filter.estimate().covariance(),
            expected.covariance(),
            epsilon = ROUNDING * expected.covariance().norm()
        );
    }
}

#[test]
fn dynamic_sizes_give_what_static_sizes_give() {
    let (expected, _) = reference();
    let (motion, sensor) = dynamic(&constant_velocity(0.5), &correlated_sensor());
    let prior = Gaussian::new(DVector::zeros(4), DMatrix::identity(4, 4) * 10.0).unwrap();
    let mut filter = KalmanFilter::new(motion, prior).unwrap();
    for (k, expected) in (1..=STEPS).zip(&expected) {
        filter.predict(None).unwrap();
        if let Some(z) = measurement(k) {
            filter.update(&sensor, &DVector::from_column_slice(z.as_slice())).unwrap();
        }
        let estimate = filter.estimate();
        assert_abs_diff_eq!(
            DVector::from_column_slice(expected.mean().as_slice()),
            estimate.mean(),
            epsilon = ROUNDING * expected.mean().norm().max(1.0)
        );
        let covariance = DMatrix::from_column_slice(4, 4, expected.covariance().as_slice());
        assert_abs_diff_eq!(
            covariance,
            estimate.covariance(),
            epsilon = ROUNDING * expected.covariance().norm()
        );
    }
}

#[test]
fn single_precision_follows_double_precision() {
    let (expected, _) = reference();
    let (motion, sensor) = (constant_velocity(0.5), correlated_sensor());
    let motion = LinearMotion::new(motion.transition().cast::<f32>(), motion.noise().cast()).unwrap();
    let sensor = LinearSensor::new(sensor.matrix().cast::<f32>(), sensor.noise().cast()).unwrap();
    let prior = Gaussian::new(Vector4::zeros(), nalgebra::Matrix4::identity() * 10.0_f32).unwrap();
    let mut filter = KalmanFilter::new(motion, prior).unwrap();
    for (k, expected) in (1..=STEPS).zip(&expected) {
        filter.predict(None).unwrap();
        if let Some(z) = measurement(k) {
            filter.update(&sensor, &z.cast()).unwrap();
        }
        let error = (filter.estimate().mean().cast::<f64>() - expected.mean()).norm();
        // The same five rounding errors as above, in single precision.
        assert!(error < 1e-12 / f64::EPSILON * f64::from(f32::EPSILON) * expected.mean().norm().max(1.0));
    }
}

#[test]
fn a_measurement_of_any_size_serves_the_same_filter() {
    let mut filter = KalmanFilter::new(constant_velocity(0.5), track_prior(10.0)).unwrap();
    filter.update(&position_sensor(1.0), &Vector2::new(1.0, 2.0)).unwrap();
    let speed = LinearSensor::new(nalgebra::RowVector4::new(0.0, 0.0, 1.0, 0.0), nalgebra::Matrix1::new(0.1))
        .unwrap();
    assert_eq!(filter.update(&speed, &nalgebra::Vector1::new(3.0)).unwrap().dim(), 1);
    assert!((filter.estimate().mean().local(&Vector4::new(0.9, 1.8, 2.97, 0.0))).norm() < 0.1);
}
