use nalgebra::{DMatrix, DVector};

/// Observes one number of the state: $`z = θ_i + v`$, $`v ∼ N(0, r)`$. Gives $`\ln N(z; μ_i, Σ_{ii} + r)`$.
///
/// Measurement noise is diagonal, so a colour is three scalar updates, and nothing is inverted. $`Σ ← Σ - \frac{Σ e_i e_i^T Σ}{Σ_{ii} + r}`$ subtracts
/// the outer product of one vector with itself, so symmetry holds to the bit; $`r`$ is never small against $`Σ_{ii}`$'s rounding, so the
/// diagonal stays positive.
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
    let column = covariance.column(i).clone_owned();
    mean.axpy(residual / variance, &column, 1.0);
    let per_variance = 1.0 / variance;
    for (k, target) in covariance.as_mut_slice().chunks_exact_mut(n).enumerate() {
        let scale = column[k] * per_variance;
        // The lower triangle of column k, then mirrored below.
        for (value, factor) in target[k..].iter_mut().zip(&column.as_slice()[k..]) {
            *value -= scale * factor;
        }
    }
    mirror(covariance);
    -0.5 * (std::f64::consts::TAU.ln() + variance.ln() + residual * residual * per_variance)
}

fn mirror(matrix: &mut DMatrix<f64>) {
    for column in 0..matrix.ncols() {
        for row in column + 1..matrix.nrows() {
            matrix[(column, row)] = matrix[(row, column)];
        }
    }
}
