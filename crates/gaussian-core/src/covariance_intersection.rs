use nalgebra::{DefaultAllocator, Dim, OMatrix, RealField, allocator::Allocator};
use wayfix_estimation_traits::{Manifold, StateAlloc, Tangent, TangentMatrix, to_f64};

use crate::{
    Gaussian, GaussianError, IterationError, check_covariance, cholesky, product::relinearized, symmetrize,
};

/// The criterion that the weights of covariance intersection minimize.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Default)]
pub enum IntersectionCriterion {
    /// The sum of the variances. Mixes units: scale the state first.
    Trace,
    /// The volume of the ellipsoid; the same in any units.
    #[default]
    Determinant,
}

/// A fused estimate that is never overconfident, for any correlation of the estimates.
#[derive(Clone, Debug, PartialEq)]
pub struct CovarianceIntersection<X: Manifold>
where
    DefaultAllocator: StateAlloc<X::Dim>,
{
    /// The fused estimate.
    pub gaussian: Gaussian<X>,
    /// The share of each estimate, adding up to one.
    pub weights: Vec<f64>,
    /// Distance of the criterion from its minimum: relative for the trace, in nats per dimension for the determinant.
    /// Any weights are consistent, so a gap only makes the covariance larger than necessary.
    pub optimality_gap: f64,
}

const MAX_ITERATIONS: usize = 2000;
/// Relative; single precision stops at the rounding of its sensitivities instead.
const GAP: f64 = 1e-7;

/// Fuses two or more estimates whose correlations are unknown.
///
/// $`Σ^{-1} = \sum ω_i Σ_i^{-1}`$, $`Σ^{-1} μ = \sum ω_i Σ_i^{-1} μ_i`$ with $`\sum ω_i = 1`$ chosen by `criterion`, a convex problem.
/// [Julier & Uhlmann 1997; Niehsen 2002 for many]
/// The weights come by the multiplicative iteration of optimal design, whose gap to the optimum is known. [Yu 2010]
/// On manifolds the weights are found in the tangent space at the first mean, the mean by Gauss-Newton.
///
/// ```
/// use nalgebra::Vector2;
/// use wayfix_gaussian_core::{Gaussian, IntersectionCriterion, covariance_intersection};
/// let wide = Gaussian::from_sigmas(Vector2::new(0.0, 0.0), &Vector2::new(2.0, 1.0))?;
/// let tall = Gaussian::from_sigmas(Vector2::new(1.0, 1.0), &Vector2::new(1.0, 2.0))?;
/// let fused = covariance_intersection(&[wide, tall], IntersectionCriterion::Determinant)?;
/// assert!((fused.weights[0] - 0.5).abs() < 1e-3); // by symmetry
/// // An estimate fused with itself gains nothing: it may be the same information.
/// let same = covariance_intersection(&[fused.gaussian.clone(), fused.gaussian.clone()], IntersectionCriterion::Trace)?;
/// assert!((same.gaussian.covariance() - fused.gaussian.covariance()).norm() < 1e-12_f64);
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
///
/// # Errors
/// Returns an error if there are no estimates, dimensions differ, or a covariance (unchecked) is not positive definite.
pub fn covariance_intersection<X: Manifold>(
    estimates: &[Gaussian<X>],
    criterion: IntersectionCriterion,
) -> Result<CovarianceIntersection<X>, IterationError<X>>
where
    DefaultAllocator: StateAlloc<X::Dim>,
{
    let first = estimates.first().ok_or(GaussianError::Empty { what: "estimates" })?;
    let seen = informations(estimates, first.mean())?;
    let (weights, gap) = optimal_weights(&seen, criterion)?;
    let gaussian = relinearized("covariance intersection", first.mean().clone(), |at| {
        let seen = informations(estimates, at)?;
        let matrix = combined(&seen, &weights);
        let mut vector = Tangent::<X>::zeros_generic(at.dim(), nalgebra::Const::<1>);
        for ((seen, estimate), &weight) in seen.iter().zip(estimates).zip(&weights) {
            vector += seen * at.local(estimate.mean()) * nalgebra::convert::<f64, X::Scalar>(weight);
        }
        let factor = cholesky("combined information", &matrix)?;
        let mut covariance = factor.solve(&TangentMatrix::<X>::identity_generic(at.dim(), at.dim()));
        symmetrize(&mut covariance);
        Ok((factor.solve(&vector), covariance))
    })?;
    Ok(CovarianceIntersection { gaussian, weights, optimality_gap: gap })
}

/// The information matrix of each estimate in the chart at `at`.
fn informations<X: Manifold>(
    estimates: &[Gaussian<X>],
    at: &X,
) -> Result<Vec<TangentMatrix<X>>, GaussianError>
where
    DefaultAllocator: StateAlloc<X::Dim>,
{
    let identity = TangentMatrix::<X>::identity_generic(at.dim(), at.dim());
    let inverse = |estimate: &Gaussian<X>| {
        let (_, covariance) = estimate.in_chart_at(at)?.into_parts();
        check_covariance("estimate", &covariance)?;
        let mut information = cholesky("estimate", &covariance)?.solve(&identity);
        symmetrize(&mut information);
        Ok(information)
    };
    estimates.iter().map(inverse).collect()
}

fn combined<T, D>(informations: &[OMatrix<T, D, D>], weights: &[f64]) -> OMatrix<T, D, D>
where
    T: RealField + Copy,
    D: Dim,
    DefaultAllocator: Allocator<D, D>,
{
    let (rows, columns) = informations[0].shape_generic();
    let mut sum = OMatrix::zeros_generic(rows, columns);
    for (information, &weight) in informations.iter().zip(weights) {
        sum += information * nalgebra::convert::<f64, T>(weight);
    }
    sum
}

/// Weights and the gap: $`ω_i ← ω_i\, g_i^p / \sum_j ω_j g_j^p`$ with the sensitivities $`g`$ of the criterion.
fn optimal_weights<T, D>(
    informations: &[OMatrix<T, D, D>],
    criterion: IntersectionCriterion,
) -> Result<(Vec<f64>, f64), GaussianError>
where
    T: RealField + Copy,
    D: Dim,
    DefaultAllocator: Allocator<D, D>,
{
    let mut weights = vec![1.0 / informations.len() as f64; informations.len()];
    let mut gap = f64::INFINITY;
    let reachable = GAP.max(100.0 * to_f64(wayfix_estimation_traits::epsilon::<T>()));
    for _ in 0..MAX_ITERATIONS {
        let sensitivities = sensitivities(&combined(informations, &weights), informations, criterion)?;
        // The weighted mean of the sensitivities is what the criterion itself comes to; at the optimum none exceeds it.
        let mean: f64 = weights.iter().zip(&sensitivities).map(|(w, g)| w * g).sum();
        let largest = sensitivities.iter().copied().fold(0.0, f64::max);
        gap = largest / mean - 1.0;
        if gap <= reachable {
            break;
        }
        // The exponents for which each step is known to improve. [Yu 2010]
        let power = match criterion {
            IntersectionCriterion::Determinant => 1.0,
            IntersectionCriterion::Trace => 0.5,
        };
        for (weight, sensitivity) in weights.iter_mut().zip(&sensitivities) {
            *weight *= (sensitivity / mean).powf(power);
        }
        let sum: f64 = weights.iter().sum();
        weights.iter_mut().for_each(|weight| *weight /= sum);
    }
    Ok((weights, gap))
}

/// $`\mathrm{tr}(Λ^{-1} Λ_i)`$ for the determinant, $`\mathrm{tr}(Λ^{-1} Λ_i Λ^{-1})`$ for the trace.
fn sensitivities<T, D>(
    combined: &OMatrix<T, D, D>,
    informations: &[OMatrix<T, D, D>],
    criterion: IntersectionCriterion,
) -> Result<Vec<f64>, GaussianError>
where
    T: RealField + Copy,
    D: Dim,
    DefaultAllocator: Allocator<D, D>,
{
    let factor = cholesky("combined information", combined)?;
    let sensitivity = |information: &OMatrix<T, D, D>| {
        let once = factor.solve(information);
        to_f64(match criterion {
            IntersectionCriterion::Determinant => once.trace(),
            IntersectionCriterion::Trace => factor.solve(&once.transpose()).trace(),
        })
    };
    Ok(informations.iter().map(sensitivity).collect())
}
