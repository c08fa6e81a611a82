use std::ops::Range;

use nalgebra::{DMatrix, DMatrixView, DVectorViewMut, Dyn, Storage};

/// Rows of an observation Jacobian: each touches the robot and one landmark.
#[derive(Clone, Debug, Default)]
pub(crate) struct SparseJacobian {
    rows: Vec<Row>,
    coefficients: Vec<f64>,
}

#[derive(Clone, Debug)]
struct Row {
    robot: Range<usize>,
    offset: usize,
    landmark: Range<usize>,
}

impl SparseJacobian {
    /// Adds one row: what it takes of the robot, and of the landmark block at `offset` (nothing, for an anchor).
    pub(crate) fn push_row(
        &mut self,
        robot: impl IntoIterator<Item = f64>,
        offset: usize,
        landmark: impl IntoIterator<Item = f64>,
    ) {
        let robot = self.push(robot);
        let landmark = self.push(landmark);
        self.rows.push(Row { robot, offset, landmark });
    }

    fn push(&mut self, coefficients: impl IntoIterator<Item = f64>) -> Range<usize> {
        let start = self.coefficients.len();
        self.coefficients.extend(coefficients);
        start..self.coefficients.len()
    }

    pub(crate) fn nrows(&self) -> usize {
        self.rows.len()
    }

    /// $`P H^T`$, reading only the lower triangle of `P`.
    pub(super) fn lower_times_transpose(&self, p: &DMatrixView<'_, f64>) -> DMatrix<f64> {
        let mut product = DMatrix::zeros(p.nrows(), self.nrows());
        for (row, mut column) in self.rows.iter().zip(product.column_iter_mut()) {
            for (state, coefficient) in self.entries(row) {
                add_symmetric_column(&mut column.as_view_mut(), coefficient, p, state);
            }
        }
        product
    }

    /// $`P H^T`$ of a full symmetric `P`.
    pub(super) fn symmetric_times_transpose(&self, p: &DMatrixView<'_, f64>) -> DMatrix<f64> {
        let mut product = DMatrix::zeros(p.nrows(), self.nrows());
        for (row, mut column) in self.rows.iter().zip(product.column_iter_mut()) {
            for (state, coefficient) in self.entries(row) {
                column.axpy(coefficient, &p.column(state), 1.0);
            }
        }
        product
    }

    /// $`H X`$.
    pub(super) fn times<S: Storage<f64, Dyn, Dyn>>(
        &self,
        x: &nalgebra::Matrix<f64, Dyn, Dyn, S>,
    ) -> DMatrix<f64> {
        DMatrix::from_fn(self.nrows(), x.ncols(), |r, c| {
            self.entries(&self.rows[r]).map(|(state, coefficient)| coefficient * x[(state, c)]).sum()
        })
    }

    fn entries<'a>(&'a self, row: &'a Row) -> impl Iterator<Item = (usize, f64)> + 'a {
        let of = |range: &Range<usize>| self.coefficients[range.clone()].iter().copied();
        (0..).zip(of(&row.robot)).chain((row.offset..).zip(of(&row.landmark)))
    }
}

/// `column += coefficient · P[:, state]`, where only the lower triangle of `P` counts.
fn add_symmetric_column(
    column: &mut DVectorViewMut<'_, f64>,
    coefficient: f64,
    p: &DMatrixView<'_, f64>,
    state: usize,
) {
    let n = p.nrows();
    for above in 0..state {
        column[above] += coefficient * p[(state, above)];
    }
    column.rows_mut(state, n - state).axpy(coefficient, &p.column(state).rows(state, n - state), 1.0);
}
