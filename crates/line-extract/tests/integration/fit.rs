//! Fits of points that are hardly a line, or none.

use approx::assert_abs_diff_eq;
use wayfix_line_extract::nalgebra::{Matrix2, Vector2};
use wayfix_line_extract::{HessianLine, LineEstimate, LineExtractionError, fit_line};

fn unit(n: usize) -> Vec<Matrix2<f64>> {
    vec![Matrix2::identity(); n]
}

#[test]
fn what_is_no_line_is_refused() {
    let point = Vector2::new(1.0, 2.0);
    assert_eq!(fit_line(&[], &[]), Err(LineExtractionError::TooFewPoints { got: 0, needed: 2 }));
    assert_eq!(fit_line(&[point], &unit(1)), Err(LineExtractionError::TooFewPoints { got: 1, needed: 2 }));
    assert_eq!(
        fit_line(&[point; 3], &unit(2)),
        Err(LineExtractionError::Sizes { points: 3, covariances: 2 })
    );
    assert!(matches!(
        fit_line(&[point; 5], &unit(5)),
        Err(LineExtractionError::NoDirection { n_points: 5, .. })
    ));
    for bad in [f64::NAN, f64::INFINITY, -1e300] {
        let points = [point, Vector2::new(3.0, bad), Vector2::new(5.0, 5.0)];
        assert!(matches!(fit_line(&points, &unit(3)), Err(LineExtractionError::Point { index: 1, .. })));
    }
    for bad in [f64::NAN, f64::INFINITY, 0.0, -1.0] {
        let points = [point, Vector2::new(3.0, 3.0), Vector2::new(5.0, 5.0)];
        let mut covariances = unit(3);
        covariances[2] *= bad;
        assert!(matches!(fit_line(&points, &covariances), Err(LineExtractionError::Param { .. })), "{bad}");
    }
}

#[test]
fn two_points_are_enough_and_are_on_the_line() {
    for turn in 0..16 {
        let angle = 0.4 * f64::from(turn);
        let direction = Vector2::new(angle.cos(), angle.sin());
        let points = [Vector2::new(3.0, -1.0), Vector2::new(3.0, -1.0) + direction];
        let fit = fit_line(&points, &unit(2)).expect("two different points");
        for point in &points {
            assert!(fit.estimate.line.signed_distance(point).abs() < 1e-12);
        }
        assert!(fit.estimate.line.rho() >= 0.0);
    }
}

#[test]
fn the_same_points_elsewhere_give_the_same_line_elsewhere() {
    // The covariance of a line moved by m follows from ρ' = ρ + n·m, α' = α: J = [1, t·m; 0, 1]. A line far off loses no digits.
    let points: Vec<_> = (0..30).map(|k| Vector2::new(0.1 * f64::from(k), 0.01 * f64::from(k % 3))).collect();
    let here = fit_line(&points, &unit(30)).expect("a line").estimate;
    for shift in [Vector2::new(5.0, 8.0), Vector2::new(-1e6, 2e6)] {
        let moved: Vec<_> = points.iter().map(|p| p + shift).collect();
        let there = fit_line(&moved, &unit(30)).expect("a line").estimate;
        let jacobian = Matrix2::new(1.0, here.line.direction().dot(&shift), 0.0, 1.0);
        let line = HessianLine::new(here.line.rho() + here.line.normal().dot(&shift), here.line.alpha());
        let expected = LineEstimate { line, covariance: jacobian * here.covariance * jacobian.transpose() };
        // Coordinates of 2e6 m have a resolution of 2e-10 m, over 3 m.
        assert_abs_diff_eq!(there.line.alpha(), expected.line.alpha(), epsilon = 1e-9);
        assert_abs_diff_eq!(
            there.covariance,
            expected.covariance,
            epsilon = 1e-6 * expected.covariance.norm()
        );
    }
}

#[test]
fn covariances_that_are_none_are_refused() {
    let line = HessianLine::new(1.0, 0.0);
    for bad in [Matrix2::zeros(), -Matrix2::identity(), Matrix2::from_element(f64::NAN)] {
        let estimate = LineEstimate { line, covariance: bad };
        assert!(matches!(
            estimate.mahalanobis_squared(&estimate),
            Err(LineExtractionError::NotPositiveDefinite { .. })
        ));
    }
}
