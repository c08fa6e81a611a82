use nalgebra::DMatrix;

/// A matrix $`C`$ with the fewest columns such that $`C C^T = A`$ for a positive semidefinite $`A`$ whose entries are known to some ε.
///
/// Cholesky's factorization, the largest pivot first: if the largest remaining pivot is rounding, so is the remainder. Without this order
/// the factorization could not stop there, because the entries beside a small pivot are not small. [Higham 2002, section 10.3]
pub(super) fn semidefinite_factor(a: &DMatrix<f64>) -> DMatrix<f64> {
    let n = a.nrows();
    let mut factor = DMatrix::zeros(n, n);
    let mut left = a.diagonal();
    let mut rank = 0;
    while rank < n && left.max() > SMALLEST_PIVOT {
        let pivot = left.imax();
        let (done, mut column) = factor.columns_range_pair_mut(0..rank, rank);
        column.copy_from(&a.column(pivot));
        column.gemv(-1.0, &done, &done.row(pivot).transpose(), 1.0);
        column.unscale_mut(left[pivot].sqrt());
        left -= column.component_mul(&column);
        left[pivot] = 0.0;
        rank += 1;
    }
    factor.resize_horizontally(rank, 0.0)
}

/// Some tens of ε.
const SMALLEST_PIVOT: f64 = 1e-14;

#[cfg(test)]
mod tests {
    use approx::{abs_diff_eq, assert_abs_diff_eq};

    use super::*;

    #[test]
    fn its_square_is_the_matrix_whatever_its_rank() {
        for rank in [0, 1, 3, 6] {
            let root = DMatrix::from_fn(6, rank, |row, column| ((row + 1).pow(column as u32) as f64).sin());
            let a = &root * root.transpose();
            let c = semidefinite_factor(&a);
            // Entries of up to 6 with an ε each for six summands, and pivots dropped below 1e-14.
            assert!(abs_diff_eq!(&c * c.transpose(), a, epsilon = 1e-13), "rank {rank}");
            assert_eq!(c.ncols(), rank);
        }
    }

    #[test]
    fn a_tiny_variance_keeps_its_covariances() {
        let root = DMatrix::from_row_slice(2, 1, &[1e-8, 1.0]);
        let a = &root * root.transpose();
        let c = semidefinite_factor(&a);
        assert_abs_diff_eq!(&c * c.transpose(), &a, epsilon = 1e-15);
    }
}
