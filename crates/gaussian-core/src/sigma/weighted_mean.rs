use nalgebra::{ComplexField, Const, DefaultAllocator, Dim, RealField, allocator::Allocator};
use wayfix_estimation_traits::{Manifold, Tangent, epsilon, to_f64};

use crate::{GaussianError, IterationError, gaussian::check_dimension};

const MAX_ITERATIONS: usize = 100;

/// The weighted mean of points on a manifold: where $`\sum_i w_i (x_i ⊟ \bar x) = 0`$. [Hertzberg et al. 2013]
///
/// Weights need not be normalized and may be negative (sigma points), but their sum is positive.
///
/// ```
/// use wayfix_estimation_traits::Angle;
/// use wayfix_gaussian_core::weighted_mean;
/// let across_the_wrap = [Angle::new(3.1_f64), Angle::new(-3.1)];
/// let mean = weighted_mean(&across_the_wrap, &[1.0, 1.0])?;
/// assert!((mean.radians().abs() - std::f64::consts::PI).abs() < 1e-12);
/// # Ok::<(), wayfix_gaussian_core::IterationError<Angle<f64>>>(())
/// ```
///
/// # Errors
/// [`IterationError::NotConverged`] with the last estimate when points are spread all round; [`IterationError::Step`] for empty or
/// uneven lists, points or weights that are not finite, a sum of weights that is not positive.
pub fn weighted_mean<X: Manifold>(points: &[X], weights: &[f64]) -> Result<X, IterationError<X>>
where
    DefaultAllocator: Allocator<X::Dim>,
{
    let scaled = ScaledWeights::new(points, weights)?;
    let start = points[scaled.heaviest].clone();
    iterate(start, &scaled, points)
}

/// The [`weighted_mean`] that is nearest to a start: points that are spread half round a circle have another one opposite.
///
/// # Errors
/// Those of [`weighted_mean`].
pub(crate) fn weighted_mean_near<X: Manifold>(
    start: &X,
    points: &[X],
    weights: &[f64],
) -> Result<X, IterationError<X>>
where
    DefaultAllocator: Allocator<X::Dim>,
{
    let scaled = ScaledWeights::new(points, weights)?;
    iterate(start.clone(), &scaled, points)
}

fn iterate<X: Manifold>(start: X, scaled: &ScaledWeights<X>, points: &[X]) -> Result<X, IterationError<X>>
where
    DefaultAllocator: Allocator<X::Dim>,
{
    let mut mean = start;
    let mut rounding = nalgebra::zero::<X::Scalar>();
    let mut length = rounding;
    for _ in 0..MAX_ITERATIONS {
        let (step, spread) = scaled.step(&mean, points);
        length = step.norm();
        if !length.is_finite() {
            return Err(GaussianError::NotFinite { what: "point" }.into());
        }
        let next = mean.retract(&step);
        // What a short step there and back loses is the rounding of coordinates at this place; no step gets below it.
        if length < nalgebra::one() {
            rounding = rounding.max((mean.local(&next) - &step).norm());
        }
        mean = next;
        if length <= spread * scaled.tolerance + rounding * nalgebra::convert(8.0) {
            return Ok(mean);
        }
    }
    let step = to_f64(length);
    Err(IterationError::NotConverged { what: "weighted mean", last: mean, iterations: MAX_ITERATIONS, step })
}

struct ScaledWeights<X: Manifold> {
    weights: Vec<X::Scalar>,
    heaviest: usize,
    tolerance: X::Scalar,
}

impl<X: Manifold> ScaledWeights<X>
where
    DefaultAllocator: Allocator<X::Dim>,
{
    fn new(points: &[X], weights: &[f64]) -> Result<Self, GaussianError> {
        let Some(first) = points.first() else { return Err(GaussianError::Empty { what: "points" }) };
        check_dimension("weights", points.len(), weights.len())?;
        for point in points {
            check_dimension("point", first.dim().value(), point.dim().value())?;
        }
        if let Some(index) = weights.iter().position(|weight| !weight.is_finite()) {
            return Err(GaussianError::Weight { index, value: weights[index] });
        }
        let sum: f64 = weights.iter().sum();
        if sum <= 0.0 {
            return Err(GaussianError::NoWeight { count: weights.len() });
        }
        let heaviest = (0..weights.len()).max_by(|&i, &j| weights[i].total_cmp(&weights[j])).unwrap_or(0);
        // Weights of sigma points are large and cancel, and their rounding with them.
        let cancellation = nalgebra::convert(4.0 * weights.iter().map(|w| w.abs()).sum::<f64>() / sum);
        let unit = epsilon::<X::Scalar>();
        let tolerance = unit.powf(nalgebra::convert(0.75)) + unit * cancellation;
        Ok(Self {
            weights: weights.iter().map(|w| nalgebra::convert(w / sum)).collect(),
            heaviest,
            tolerance,
        })
    }

    /// The mean deviation from `mean`, and the length of the longest.
    fn step(&self, mean: &X, points: &[X]) -> (Tangent<X>, X::Scalar) {
        let mut step = Tangent::<X>::zeros_generic(mean.dim(), Const::<1>);
        let mut spread = nalgebra::zero::<X::Scalar>();
        for (point, &weight) in points.iter().zip(&self.weights) {
            let deviation = mean.local(point);
            spread = spread.max(deviation.norm());
            step += deviation * weight;
        }
        (step, spread)
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use approx::assert_abs_diff_eq;
    use nalgebra::{DVector, Vector1, Vector2};
    use wayfix_estimation_traits::{Angle, Pose2};

    #[test]
    fn mean_of_vectors_far_from_the_origin_is_arithmetic() {
        for origin in [0.0, 1e3, 1e9, -1e15] {
            let at = |x: f64, y: f64| Vector2::new(origin + x, origin - y);
            let mean = weighted_mean(&[at(0.0, 0.0), at(4.0, 2.0)], &[1.0, 3.0]).unwrap();
            assert_abs_diff_eq!(mean, at(3.0, 1.5), epsilon = 2.0 * f64::EPSILON * (1.0 + origin.abs()));
        }
    }

    #[test]
    fn deviations_from_the_mean_of_poses_cancel() {
        let poses = [Pose2::<f64>::new(1.0, 2.0, 3.0), Pose2::new(1.5, 2.5, -3.0), Pose2::new(0.0, 1.0, 2.5)];
        let weights = [0.2, 0.5, 0.3];
        let mean = weighted_mean(&poses, &weights).unwrap();
        let residual =
            poses.iter().zip(weights).map(|(p, w)| mean.local(p) * w).sum::<nalgebra::Vector3<f64>>();
        assert!(residual.norm() < 1e-11, "residual {residual}");
    }

    #[test]
    fn bad_lists_are_refused() {
        let zero = [Vector1::new(0.0)];
        assert_eq!(
            weighted_mean(&zero, &[0.0]),
            Err(IterationError::Step(GaussianError::NoWeight { count: 1 }))
        );
        assert!(weighted_mean::<Angle<f64>>(&[], &[]).is_err());
        assert!(weighted_mean(&zero, &[1.0, 2.0]).is_err());
        assert!(weighted_mean(&zero, &[f64::NAN]).is_err());
        assert!(weighted_mean(&[Vector1::new(f64::NAN)], &[1.0]).is_err());
        assert!(
            weighted_mean(&[DVector::from_vec(vec![1.0]), DVector::from_vec(vec![1.0, 2.0])], &[1.0, 1.0])
                .is_err()
        );
    }

    #[test]
    fn a_mean_that_runs_away_comes_back_in_the_error() {
        // Weights of opposite sign across the circle push the estimate on and on (a numpy loop over 100 steps ends with 1.71 rad).
        let points = [Angle::new(0.0), Angle::new(2.9), Angle::new(1.6)];
        match weighted_mean(&points, &[0.3, 2.9, -2.1]) {
            Err(IterationError::NotConverged { last, iterations, .. }) => {
                assert!(last.radians().is_finite() && iterations == 100);
            }
            other => panic!("expected no convergence, got {other:?}"),
        }
    }
}
