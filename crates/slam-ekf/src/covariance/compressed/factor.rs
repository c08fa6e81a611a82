use nalgebra::DMatrix;

/// A lower-triangular $`C`$ with $`C C^T = A`$ for a positive semidefinite $`A`$.
///
/// Where nothing but rounding is left of a pivot its column is zero: $`C C^T`$ then is a little smaller than $`A`$, never larger.
pub(super) fn semidefinite_factor(mut a: DMatrix<f64>) -> DMatrix<f64> {
    let n = a.nrows();
    let smallest: Vec<f64> = a.diagonal().iter().map(|variance| RANK_TOLERANCE * variance).collect();
    for column in 0..n {
        for earlier in 0..column {
            let factor = a[(column, earlier)];
            let (from, mut to) = a.columns_range_pair_mut(earlier, column);
            to.rows_mut(column, n - column).axpy(-factor, &from.rows(column, n - column), 1.0);
        }
        let pivot = a[(column, column)];
        let mut rest = a.view_mut((column, column), (n - column, 1));
        if pivot > smallest[column] {
            rest.unscale_mut(pivot.sqrt());
        } else {
            rest.fill(0.0);
        }
    }
    a.fill_upper_triangle(0.0, 1);
    a
}

/// Some tens of ε: what the differences that make up a pivot lose.
const RANK_TOLERANCE: f64 = 1e-14;

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn its_square_is_the_matrix_whatever_its_rank() {
        for rank in [0, 1, 3, 6] {
            let root = DMatrix::from_fn(6, rank, |row, column| ((3 * row + 5 * column) as f64).sin());
            let a = &root * root.transpose();
            let c = semidefinite_factor(a.clone());
            // Entries of up to 6, pivots dropped below 1e-14 of them.
            assert!((&c * c.transpose() - &a).amax() < 1e-12, "rank {rank}");
            assert_eq!(c, c.lower_triangle());
        }
    }
}
