//! Figures by numpy 2 and scipy 1 (`scipy.stats`, `scipy.optimize.minimize_scalar`, plain `numpy.linalg.inv` and `det`),
//! for the two Gaussians below and the point (2, 0, 1). They share no code with us.

#![allow(clippy::unwrap_used, reason = "helpers of tests fail like tests")]

use approx::{abs_diff_eq, assert_abs_diff_eq};
use nalgebra::{Matrix3, Vector3};
use wayfix_estimation_traits::Angle;
use wayfix_gaussian_core::{
    CircularMoments, Gaussian, GaussianMixture, IntersectionCriterion, covariance_intersection,
};

type Gaussian3 = Gaussian<Vector3<f64>>;

fn gaussians() -> (Gaussian3, Gaussian3) {
    let first = Matrix3::new(4.0, 1.0, 0.5, 1.0, 3.0, 0.2, 0.5, 0.2, 2.0);
    let second = Matrix3::new(2.0, -0.3, 0.1, -0.3, 1.0, 0.4, 0.1, 0.4, 5.0);
    (
        Gaussian::new(Vector3::new(1.0, -2.0, 0.5), first).unwrap(),
        Gaussian::new(Vector3::new(0.0, 1.0, -1.0), second).unwrap(),
    )
}

/// Both sides carry some ten rounding errors at condition numbers below 10.
const ROUNDING: f64 = 1e-13;

#[test]
fn densities_and_divergences() {
    let (p, q) = gaussians();
    let point = Vector3::new(2.0, 0.0, 1.0);
    assert_abs_diff_eq!(p.log_density(&point).unwrap(), -4.995422361612508, epsilon = ROUNDING);
    assert_abs_diff_eq!(p.kl_divergence(&q).unwrap(), 6.360795142075197, epsilon = 10.0 * ROUNDING);
    assert_abs_diff_eq!(p.bhattacharyya_distance(&q).unwrap(), 0.9653961369890981, epsilon = ROUNDING);
    let mixture = GaussianMixture::from_weights(vec![(0.3, p), (0.7, q)]).unwrap();
    assert_abs_diff_eq!(mixture.log_density(&point).unwrap(), -5.392743716770693, epsilon = ROUNDING);
}

#[test]
fn products_and_moments() {
    let (p, q) = gaussians();
    let product = p.product(&q).unwrap();
    let mean = Vector3::new(0.7501610166342568, 0.20366746349257467, 0.017265937550317592);
    assert_abs_diff_eq!(*product.mean(), mean, epsilon = ROUNDING);
    let moments = GaussianMixture::from_weights(vec![(0.3, p), (0.7, q)]).unwrap().moments().unwrap();
    let covariance = Matrix3::new(2.81, -0.54, 0.535, -0.54, 3.49, -0.605, 0.535, -0.605, 4.5725);
    assert_abs_diff_eq!(*moments.mean(), Vector3::new(0.3, 0.1, -0.55), epsilon = ROUNDING);
    assert_abs_diff_eq!(*moments.covariance(), covariance, epsilon = ROUNDING);
}

#[test]
fn intersection_weights_are_those_of_a_scalar_minimizer() {
    let (p, q) = gaussians();
    for (criterion, weight, value) in [
        (IntersectionCriterion::Trace, 0.46623636338926194, 6.735244197271928),
        (IntersectionCriterion::Determinant, 0.19841457857829542, 2.168146451101405),
    ] {
        let fused = covariance_intersection(&[p.clone(), q.clone()], criterion).unwrap();
        let covariance = fused.gaussian.covariance();
        let got = match criterion {
            IntersectionCriterion::Trace => covariance.trace(),
            IntersectionCriterion::Determinant => covariance.determinant().ln(),
        };
        // The gap bounds the criterion (times the dimension for the determinant); the weight follows by its square root.
        assert!(fused.optimality_gap <= 1e-7);
        assert!(
            abs_diff_eq!(got, value, epsilon = 3e-7 * f64::max(value, 1.0)),
            "{criterion:?}: {got} against {value}"
        );
        assert!(
            abs_diff_eq!(fused.weights[0], weight, epsilon = 1e-3),
            "{criterion:?}: weight {}",
            fused.weights[0]
        );
    }
}

#[test]
fn circular_means() {
    let angles = [3.0_f64, -3.1, 2.5, -2.9].map(Angle::new);
    let moments = CircularMoments::from_weighted(&angles, &[0.1, 0.4, 0.2, 0.3]).unwrap();
    assert_abs_diff_eq!(moments.mean_direction().unwrap().radians(), 3.093848681874398, epsilon = 1e-15);
    assert_abs_diff_eq!(moments.resultant_length(), 0.9512534613615437, epsilon = 1e-15);
}
