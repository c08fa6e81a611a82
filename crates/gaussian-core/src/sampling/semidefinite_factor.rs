use nalgebra::{DefaultAllocator, Dim, OMatrix, RealField, allocator::Allocator};

/// A lower triangular $`L`$ with $`L L^T = Σ`$ for positive **semi**definite $`Σ`$: a pivot that is not positive gives a zero column.
///
/// For sampling: motion noise may be singular.
pub(super) fn semidefinite_factor<T, D>(covariance: &OMatrix<T, D, D>) -> OMatrix<T, D, D>
where
    T: RealField + Copy,
    D: Dim,
    DefaultAllocator: Allocator<D, D>,
{
    let mut l = covariance.clone();
    let n = l.nrows();
    for column in 0..n {
        // What is left of a pivot after cancellation is rounding, not variance.
        let floor = covariance[(column, column)].abs() * T::default_epsilon() * nalgebra::convert(n as f64);
        for row in 0..column {
            l[(row, column)] = T::zero();
        }
        let pivot = l[(column, column)];
        let root = if pivot <= floor { T::zero() } else { pivot.sqrt() };
        for row in column..n {
            l[(row, column)] = if root == T::zero() { T::zero() } else { l[(row, column)] / root };
        }
        for right in column + 1..n {
            let factor = l[(right, column)];
            for row in right..n {
                let product = factor * l[(row, column)];
                l[(row, right)] -= product;
            }
        }
    }
    l
}

#[cfg(test)]
mod tests {
    use super::*;
    use approx::assert_abs_diff_eq;
    use nalgebra::{Matrix2, Matrix3, Vector3};

    #[test]
    fn semidefinite_matrix_is_factored_where_cholesky_fails() {
        let a = Vector3::new(1.0, -2.0, 3.0);
        let b = Vector3::new(2.0, -4.0, 5.0);
        let singular: Matrix3<f64> = a * a.transpose() + b * b.transpose();
        let l = semidefinite_factor(&singular);
        assert_abs_diff_eq!(l * l.transpose(), singular, epsilon = 1e-13 * singular.norm());
        assert_eq!(semidefinite_factor(&Matrix2::<f64>::zeros()), Matrix2::zeros());
    }
}
