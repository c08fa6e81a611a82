use nalgebra::{DMatrix, DVector};

/// Observes one component of the state: $`z = θ_i + v`$, $`v ∼ N(0, r)`$. Returns $`\ln N(z; μ_i, Σ_{ii} + r)`$. [Schulz & Fox 2004, Eqs. 3–5]
///
/// The noise of a mean is diagonal, so a colour takes three scalar updates, exactly, without factorization and allocation.
///
/// With $`c = Σ e_i`$ and $`s = Σ_{ii} + r`$ the new covariance is $`Σ - c c^T / s`$. Entries across the diagonal are computed by the same two
/// products, $`(c_j c_k) / s`$, so it is exactly symmetric. Row and column $`i`$ are multiplied by $`r / s`$, without a difference, as in Joseph's
/// form. Since $`c c^T ⪯ Σ_{ii} Σ`$, the remainder is at least $`(r / s)\, Σ`$: positive definite as long as $`r / s`$ is far above rounding, which
/// [`LightingFilterParams`](super::LightingFilterParams) ensures.
pub(super) fn observe(
    mean: &mut DVector<f64>,
    covariance: &mut DMatrix<f64>,
    i: usize,
    z: f64,
    r: f64,
) -> f64 {
    let n = mean.len();
    let variance = covariance[(i, i)] + r;
    let residual = z - mean[i];
    let (per_variance, stays) = (1.0 / variance, r / variance);
    let (before, rest) = covariance.as_mut_slice().split_at_mut(i * n);
    let (cross, after) = rest.split_at_mut(n);
    for (mean, cross) in mean.iter_mut().zip(&*cross) {
        *mean += cross * (residual * per_variance);
    }
    let others = (0..).zip(before.chunks_exact_mut(n)).chain((i + 1..).zip(after.chunks_exact_mut(n)));
    for (k, column) in others {
        for (value, cross_j) in column.iter_mut().zip(&*cross) {
            *value -= (cross_j * cross[k]) * per_variance;
        }
        column[i] = cross[k] * stays;
    }
    // The other updates use its old value, so it comes last.
    cross.iter_mut().for_each(|value| *value *= stays);
    -0.5 * (std::f64::consts::TAU.ln() + variance.ln() + residual * residual * per_variance)
}
