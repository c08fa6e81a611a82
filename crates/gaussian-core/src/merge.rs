use nalgebra::{DefaultAllocator, OMatrix};
use wayfix_estimation_traits::{Manifold, StateAlloc};

use crate::{Gaussian, GaussianError, IterationError, symmetrize, weighted_mean};

/// The one Gaussian with the mean and covariance of a weighted sum of Gaussians.
///
/// $`\bar μ = \sum w_i μ_i`$, $`\bar Σ = \sum w_i (Σ_i + d_i d_i^T)`$ with $`d_i = μ_i ⊟ \bar μ`$, each covariance carried to the tangent space
/// at the mean. Weights need not be normalized. [Runnalls 2007]
///
/// ```
/// use nalgebra::Vector1;
/// use wayfix_gaussian_core::{Gaussian, moment_matched};
/// let left = Gaussian::from_sigmas(Vector1::new(-1.0), &Vector1::new(1.0))?;
/// let right = Gaussian::from_sigmas(Vector1::new(1.0), &Vector1::new(1.0))?;
/// let both = moment_matched(&[1.0, 1.0], &[left, right])?;
/// assert_eq!((both.mean()[0], both.covariance()[(0, 0)]), (0.0, 2.0)); // variance within plus variance between
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
///
/// # Errors
/// Returns an error if lists are empty or uneven, a weight is negative or not finite, all are zero, or the mean is not found.
pub fn moment_matched<X: Manifold>(
    weights: &[f64],
    components: &[Gaussian<X>],
) -> Result<Gaussian<X>, IterationError<X>>
where
    DefaultAllocator: StateAlloc<X::Dim>,
{
    if let Some(index) = weights.iter().position(|&weight| weight < 0.0) {
        return Err(GaussianError::Weight { index, value: weights[index] }.into());
    }
    let means: Vec<X> = components.iter().map(|component| component.mean().clone()).collect();
    let mean = weighted_mean(&means, weights)?;
    let sum: f64 = weights.iter().sum();
    let mut covariance = OMatrix::zeros_generic(mean.dim(), mean.dim());
    for (component, weight) in components.iter().zip(weights) {
        let (deviation, spread) = component.in_chart_at(&mean)?.into_parts();
        let share = nalgebra::convert::<f64, X::Scalar>(weight / sum);
        covariance += spread * share;
        covariance.ger(share, &deviation, &deviation, nalgebra::one());
    }
    symmetrize(&mut covariance);
    Ok(Gaussian::from_parts_unchecked(mean, covariance))
}
