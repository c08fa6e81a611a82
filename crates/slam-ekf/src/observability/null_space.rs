use nalgebra::{DMatrix, DVector};

/// Directions in which a symmetric positive semidefinite matrix is zero: an orthonormal basis as columns, after scaling by `scale`.
///
/// Scaling by the possible size of each entry makes metres and radians comparable. An eigenvalue below `share` of 1 counts as zero.
pub(super) fn null_space(matrix: &DMatrix<f64>, scale: &DVector<f64>, share: f64) -> DMatrix<f64> {
    if matrix.nrows() == 0 {
        return DMatrix::zeros(0, 0);
    }
    let scale = scale.map(|square| if square > 0.0 { square.sqrt() } else { 1.0 });
    let scaled =
        DMatrix::from_fn(matrix.nrows(), matrix.ncols(), |i, j| matrix[(i, j)] / (scale[i] * scale[j]));
    let eigen = scaled.symmetric_eigen();
    let null: Vec<DVector<f64>> = (0..eigen.eigenvalues.len())
        .filter(|&i| eigen.eigenvalues[i] <= share)
        .map(|i| eigen.eigenvectors.column(i).component_div(&scale).normalize())
        .collect();
    if null.is_empty() { DMatrix::zeros(matrix.nrows(), 0) } else { DMatrix::from_columns(&null) }
}

/// The same space with a readable basis: each vector has a 1 where all others have a 0.
pub(super) fn readable(mut basis: DMatrix<f64>) -> Vec<DVector<f64>> {
    for vector in 0..basis.ncols() {
        let pivot = basis.column(vector).icamax();
        let divisor = basis[(pivot, vector)];
        basis.column_mut(vector).unscale_mut(divisor);
        let reduced = basis.column(vector).into_owned();
        for other in (0..basis.ncols()).filter(|&other| other != vector) {
            let factor = basis[(pivot, other)];
            basis.column_mut(other).axpy(-factor, &reduced, 1.0);
        }
    }
    basis.column_iter().map(|column| column.into_owned()).collect()
}

#[cfg(test)]
mod tests {
    use super::*;
    use approx::abs_diff_eq;

    #[test]
    fn finds_the_direction_that_a_known_matrix_lacks() {
        let matrix = DMatrix::from_row_slice(2, 2, &[1.0, -1.0, -1.0, 1.0]) * 7.0; // [Andrade-Cetto 2005, Eq. 17]
        let null = null_space(&matrix, &matrix.diagonal(), 1e-9);
        assert_eq!(null.ncols(), 1);
        assert!(abs_diff_eq!(null[0], null[1], epsilon = 1e-12), "(1, 1), Eq. 18");
    }

    #[test]
    fn a_readable_basis_spans_the_same_space() {
        let basis = DMatrix::from_columns(&[
            DVector::from_vec(vec![1.0, 1.0, 2.0]),
            DVector::from_vec(vec![1.0, -1.0, 2.0]),
        ]);
        let readable = readable(basis);
        for expected in [[0.5, 0.0, 1.0], [0.0, 1.0, 0.0]] {
            assert!(readable.iter().any(|found| (found - DVector::from_row_slice(&expected)).norm() < 1e-12));
        }
    }
}
