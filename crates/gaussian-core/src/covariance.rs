use nalgebra::{DefaultAllocator, Dim, OMatrix, RealField, allocator::Allocator, linalg::Cholesky};
use wayfix_estimation_traits::to_f64;

use crate::GaussianError;

/// The Cholesky factorization of `covariance`, or the pivot that fails.
///
/// Solve with it; an explicit inverse is neither needed nor accurate.
/// Only the lower triangle is read: [`check_covariance`] checks the symmetry.
///
/// ```
/// use nalgebra::{Matrix2, Vector2};
/// let factor = wayfix_gaussian_core::cholesky("innovation", &Matrix2::new(4.0, 0.0, 0.0, 9.0))?;
/// assert_eq!(factor.solve(&Vector2::new(8.0, 9.0)), Vector2::new(2.0, 1.0));
/// # Ok::<(), wayfix_gaussian_core::GaussianError>(())
/// ```
///
/// # Errors
/// [`GaussianError::NotPositiveDefinite`] or, for NaN and infinities, [`GaussianError::NotFinite`].
pub fn cholesky<T, D>(
    what: &'static str,
    covariance: &OMatrix<T, D, D>,
) -> Result<Cholesky<T, D>, GaussianError>
where
    T: RealField + Copy,
    D: Dim,
    DefaultAllocator: Allocator<D, D>,
{
    let (expected, got) = covariance.shape();
    if expected != got {
        return Err(GaussianError::Dimension { what, expected, got });
    }
    let factor = Cholesky::new(covariance.clone()).ok_or_else(|| failing_pivot(what, covariance))?;
    // An infinite or NaN entry can pass the pivots without failing one.
    if factor.l_dirty().lower_triangle().iter().all(|entry| entry.is_finite()) {
        Ok(factor)
    } else {
        Err(GaussianError::NotFinite { what })
    }
}

/// Whether `covariance` is square, finite, symmetric and positive definite.
///
/// Entries across the diagonal may differ by $`\sqrt{ε}\,\sqrt{σ_{ii} σ_{jj}}`$: half the digits. Rounding in a product like
/// $`F Σ F^T`$ stays far below that, a matrix filled in wrongly far above. Scaling a state by its units changes nothing.
///
/// ```
/// use nalgebra::Matrix2;
/// use wayfix_gaussian_core::{GaussianError, check_covariance};
/// let indefinite = Matrix2::new(1.0, 2.0, 2.0, 1.0);
/// assert_eq!(
///     check_covariance("prior", &indefinite),
///     Err(GaussianError::NotPositiveDefinite { what: "prior", pivot: 1, value: -3.0 })
/// );
/// ```
///
/// # Errors
/// The first of these that fails, in that order.
pub fn check_covariance<T, D>(what: &'static str, covariance: &OMatrix<T, D, D>) -> Result<(), GaussianError>
where
    T: RealField + Copy,
    D: Dim,
    DefaultAllocator: Allocator<D, D>,
{
    check_symmetric(what, covariance)?;
    cholesky(what, covariance).map(|_| ())
}

/// Like [`check_covariance`] without the last step: square, finite, symmetric.
pub(crate) fn check_symmetric<T, D>(
    what: &'static str,
    covariance: &OMatrix<T, D, D>,
) -> Result<(), GaussianError>
where
    T: RealField + Copy,
    D: Dim,
    DefaultAllocator: Allocator<D, D>,
{
    let (expected, got) = covariance.shape();
    if expected != got {
        return Err(GaussianError::Dimension { what, expected, got });
    }
    if !covariance.iter().all(|entry| entry.is_finite()) {
        return Err(GaussianError::NotFinite { what });
    }
    let tolerance = T::default_epsilon().sqrt();
    let mut worst = T::zero();
    for column in 0..expected {
        for row in column + 1..expected {
            let difference = (covariance[(row, column)] - covariance[(column, row)]).abs();
            // Two roots rather than the root of a product, which overflows for variances near the largest float.
            let scale = covariance[(row, row)].abs().sqrt() * covariance[(column, column)].abs().sqrt();
            if difference > tolerance * scale {
                worst = worst.max(difference);
            }
        }
    }
    if worst > T::zero() {
        return Err(GaussianError::NotSymmetric { what, difference: to_f64(worst) });
    }
    Ok(())
}

/// $`(Σ + Σ^T)/2`$ in place: rounding must not let the two triangles drift apart.
///
/// ```
/// let mut covariance = nalgebra::Matrix2::new(1.0, 0.5, 0.25, 1.0);
/// wayfix_gaussian_core::symmetrize(&mut covariance);
/// assert_eq!(covariance, nalgebra::Matrix2::new(1.0, 0.375, 0.375, 1.0));
/// ```
pub fn symmetrize<T, D>(covariance: &mut OMatrix<T, D, D>)
where
    T: RealField + Copy,
    D: Dim,
    DefaultAllocator: Allocator<D, D>,
{
    let half: T = nalgebra::convert(0.5);
    let n = covariance.nrows().min(covariance.ncols());
    for column in 0..n {
        for row in column + 1..n {
            let mean = (covariance[(row, column)] + covariance[(column, row)]) * half;
            covariance[(row, column)] = mean;
            covariance[(column, row)] = mean;
        }
    }
}

/// Repeats the elimination, slowly, to find the pivot that fails.
fn failing_pivot<T, D>(what: &'static str, covariance: &OMatrix<T, D, D>) -> GaussianError
where
    T: RealField + Copy,
    D: Dim,
    DefaultAllocator: Allocator<D, D>,
{
    if !covariance.iter().all(|entry| entry.is_finite()) {
        return GaussianError::NotFinite { what };
    }
    let mut schur = covariance.clone();
    let n = schur.nrows();
    let mut smallest = (0, T::max_value().unwrap_or_else(T::one));
    for pivot in 0..n {
        let value = schur[(pivot, pivot)];
        if value < smallest.1 {
            smallest = (pivot, value);
        }
        if value <= T::zero() || !value.is_finite() {
            smallest = (pivot, value);
            break;
        }
        for right in pivot + 1..n {
            let factor = schur[(right, pivot)] / value;
            for row in right..n {
                let product = factor * schur[(row, pivot)];
                schur[(row, right)] -= product;
            }
        }
    }
    let (pivot, value) = smallest;
    GaussianError::NotPositiveDefinite { what, pivot, value: to_f64(value) }
}

#[cfg(test)]
mod tests {
    use super::*;
    use nalgebra::{DMatrix, Matrix2};

    #[test]
    fn the_report_names_the_pivot_that_fails() {
        let indefinite = DMatrix::from_diagonal(&nalgebra::DVector::from_vec(vec![1.0, 2.0, -0.5, 1.0]));
        assert_eq!(
            check_covariance("prior", &indefinite),
            Err(GaussianError::NotPositiveDefinite { what: "prior", pivot: 2, value: -0.5 })
        );
        assert_eq!(
            check_covariance("prior", &Matrix2::<f64>::zeros()),
            Err(GaussianError::NotPositiveDefinite { what: "prior", pivot: 0, value: 0.0 })
        );
    }

    #[test]
    fn non_finite_and_lopsided_matrices_are_refused_as_such() {
        for bad in [f64::NAN, f64::INFINITY, f64::NEG_INFINITY] {
            for entry in 0..4 {
                let mut matrix = Matrix2::identity();
                matrix[entry] = bad;
                assert_eq!(check_covariance("q", &matrix), Err(GaussianError::NotFinite { what: "q" }));
                assert!(cholesky("q", &matrix).is_err() || entry == 2, "entry {entry} = {bad} was factored");
            }
        }
        let lopsided = Matrix2::new(1.0, 0.5, 0.4, 1.0);
        assert!(matches!(check_covariance("q", &lopsided), Err(GaussianError::NotSymmetric { .. })));
        // Variances sixteen orders apart, correlation 0.5, the off-diagonals equal to ten digits: fine in any units.
        let units = Matrix2::new(1e8, 0.5, 0.5 * (1.0 + 1e-10), 1e-8);
        assert_eq!(check_covariance("q", &units), Ok(()));
        assert!(check_covariance("q", &DMatrix::<f64>::identity(2, 3)).is_err());
    }
}
