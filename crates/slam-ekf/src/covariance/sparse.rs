use std::ops::Range;

use nalgebra::{DMatrix, DMatrixView, DVector};

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

    /// The landmark blocks that it touches, one a row.
    pub(super) fn landmarks(&self) -> impl Iterator<Item = Range<usize>> + '_ {
        let touching = self.rows.iter().filter(|row| !row.landmark.is_empty());
        touching.map(|row| row.offset..row.offset + row.landmark.len())
    }

    /// The same rows for states in another order: `place` says where a landmark block starts there.
    pub(super) fn relocated(&self, place: impl Fn(usize) -> usize) -> Self {
        let mut relocated = self.clone();
        for row in &mut relocated.rows {
            row.offset = place(row.offset);
        }
        relocated
    }

    /// $`P H^T`$ of a symmetric `P`.
    pub(super) fn times_transpose(&self, p: &DMatrixView<'_, f64>) -> DMatrix<f64> {
        let mut product = DMatrix::zeros(p.nrows(), self.nrows());
        for (row, mut column) in self.rows.iter().zip(product.column_iter_mut()) {
            for (state, coefficient) in self.entries(row) {
                column.axpy(coefficient, &p.column(state), 1.0);
            }
        }
        product
    }

    /// $`H X`$.
    pub(super) fn times(&self, x: &DMatrix<f64>) -> DMatrix<f64> {
        DMatrix::from_fn(self.nrows(), x.ncols(), |r, c| {
            self.entries(&self.rows[r]).map(|(state, coefficient)| coefficient * x[(state, c)]).sum()
        })
    }

    /// $`(\sum_i |h_i| \sqrt{P_{ii}})^2`$ of each row: what its variance would be if nothing cancelled.
    pub(super) fn largest_variances(&self, p: &DMatrixView<'_, f64>) -> DVector<f64> {
        let deviation = |(state, coefficient): (usize, f64)| coefficient.abs() * p[(state, state)].sqrt();
        DVector::from_fn(self.nrows(), |row, _| {
            self.entries(&self.rows[row]).map(deviation).sum::<f64>().powi(2)
        })
    }

    fn entries<'a>(&'a self, row: &'a Row) -> impl Iterator<Item = (usize, f64)> + 'a {
        let of = |range: &Range<usize>| self.coefficients[range.clone()].iter().copied();
        (0..).zip(of(&row.robot)).chain((row.offset..).zip(of(&row.landmark)))
    }
}
