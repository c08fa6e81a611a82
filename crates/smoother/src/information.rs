use nalgebra::DMatrix;

use crate::SmootherError;

/// Rounding of an information matrix written with six digits or more, relative to its largest entry.
const WRITTEN_DIGITS: f64 = 1e-6;

/// Eigenvalues below zero by more than this share of the largest are negative; smaller ones are rounding.
const ROUNDING: f64 = 1e-12;

/// Checks that a matrix is square, finite, symmetric, and has no negative eigenvalue. Singular ones pass.
pub(crate) fn check(matrix: &DMatrix<f64>, residual: usize) -> Result<(), SmootherError> {
    let (what, n) = ("the information", matrix.nrows());
    if !matrix.is_square() {
        return Err(SmootherError::Shape { what, residual, expected: (n, n), got: matrix.shape() });
    }
    if !matrix.iter().all(|entry| entry.is_finite()) {
        return Err(SmootherError::NotFinite { what, residual: Some(residual) });
    }
    let difference = (matrix - matrix.transpose()).amax();
    if difference > WRITTEN_DIGITS * matrix.amax() {
        return Err(SmootherError::AsymmetricInformation { difference });
    }
    if nalgebra::Cholesky::new(matrix.clone()).is_some() {
        return Ok(());
    }
    let eigenvalues = matrix.symmetric_eigenvalues();
    let (smallest, largest) = (eigenvalues.min(), eigenvalues.max());
    if smallest < -ROUNDING * largest.abs() {
        return Err(SmootherError::IndefiniteInformation { smallest, largest });
    }
    Ok(())
}

/// The nearest matrix without negative eigenvalues: they become 0. [Higham 1988, Theorem 2.1]
pub(crate) fn clipped(matrix: &DMatrix<f64>) -> DMatrix<f64> {
    let mut eigen = matrix.clone().symmetric_eigen();
    eigen.eigenvalues.apply(|value| *value = value.max(0.0));
    let clipped = eigen.recompose();
    clipped.symmetric_part()
}
