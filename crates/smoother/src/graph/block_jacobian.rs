use nalgebra::{DMatrix, DVector};

use super::{linear_point::LinearPoint, values::Values};

/// Derivatives of the differences from linear points: few blocks, of which each row of blocks ends with that of its own variable.
pub(super) struct BlockJacobian {
    /// First coordinate and dimension of each variable.
    pub(super) places: Vec<(usize, usize)>,
    /// Places of the differences and of the variables, and the derivatives.
    blocks: Vec<(usize, usize, DMatrix<f64>)>,
}

impl BlockJacobian {
    /// The differences, and their derivatives by the variables.
    pub(super) fn of(
        variables: &[usize],
        points: &[Box<dyn LinearPoint>],
        values: &Values,
    ) -> (DVector<f64>, Self) {
        let locals: Vec<_> = points.iter().map(|point| point.local(values)).collect();
        let mut places = Vec::with_capacity(locals.len());
        let mut n = 0;
        for local in &locals {
            places.push((n, local.delta.len()));
            n += local.delta.len();
        }
        let delta = DVector::from_iterator(n, locals.iter().flat_map(|local| local.delta.iter().copied()));
        let mut blocks = Vec::with_capacity(2 * locals.len());
        for (place, local) in locals.into_iter().enumerate() {
            for (variable, jacobian) in local.jacobians {
                if let Ok(column) = variables.binary_search(&variable) {
                    blocks.push((place, column, jacobian));
                }
            }
        }
        (delta, Self { places, blocks })
    }

    /// $`J^T H J`$ for a symmetric $`H`$.
    pub(super) fn congruence(&self, hessian: &DMatrix<f64>) -> DMatrix<f64> {
        self.multiply_left(&self.multiply_left(hessian).transpose())
    }

    /// $`J^T v`$
    pub(super) fn transpose_multiply(&self, vector: &DVector<f64>) -> DVector<f64> {
        let mut product = DVector::zeros(vector.len());
        for (row, column, block) in &self.blocks {
            let ((row, n_rows), (column, n_columns)) = (self.places[*row], self.places[*column]);
            product.rows_mut(column, n_columns).gemv_tr(1.0, block, &vector.rows(row, n_rows), 1.0);
        }
        product
    }

    /// $`H J`$
    fn multiply_left(&self, matrix: &DMatrix<f64>) -> DMatrix<f64> {
        let mut product = DMatrix::zeros(matrix.nrows(), matrix.ncols());
        for (row, column, block) in &self.blocks {
            let ((row, n_rows), (column, n_columns)) = (self.places[*row], self.places[*column]);
            product.columns_mut(column, n_columns).gemm(1.0, &matrix.columns(row, n_rows), block, 1.0);
        }
        product
    }

    /// The inverse: the blocks of the variables themselves are inverted, and the base is that of the others. `None` if it has none.
    pub(super) fn inverse(&self) -> Option<Self> {
        let own =
            |place: usize| self.blocks.iter().find(|(row, column, _)| (*row, *column) == (place, place));
        let mut blocks = Vec::with_capacity(self.blocks.len());
        for (row, column, block) in &self.blocks {
            let inverse = own(*row)?.2.clone().try_inverse()?;
            let block = if row == column {
                inverse
            } else {
                -(inverse * block) * own(*column)?.2.clone().try_inverse()?
            };
            blocks.push((*row, *column, block));
        }
        Some(Self { places: self.places.clone(), blocks })
    }
}
