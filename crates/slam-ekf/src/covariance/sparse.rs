use std::ops::Range;

use nalgebra::{DMatrix, DMatrixView, DVector};

/// Rows of a Jacobian, each of which touches two blocks of the state: the robot and one landmark, or two landmarks.
#[derive(Clone, Debug, Default)]
pub(crate) struct SparseJacobian {
    rows: Vec<Row>,
    coefficients: Vec<f64>,
}

#[derive(Clone, Debug)]
struct Row {
    first: Block,
    second: Block,
}

/// The offset of a block in the state, and the range of its coefficients.
type Block = (usize, Range<usize>);

impl SparseJacobian {
    /// Adds one row: coefficients of the robot, and of the landmark block at `offset` (none for an anchor).
    pub(crate) fn push_row(
        &mut self,
        robot: impl IntoIterator<Item = f64>,
        offset: usize,
        landmark: impl IntoIterator<Item = f64>,
    ) {
        self.push_blocks((0, robot), (offset, landmark));
    }

    /// Adds one row: coefficients of two blocks that start at these offsets.
    pub(crate) fn push_blocks(
        &mut self,
        first: (usize, impl IntoIterator<Item = f64>),
        second: (usize, impl IntoIterator<Item = f64>),
    ) {
        let first = (first.0, self.push(first.1));
        let second = (second.0, self.push(second.1));
        self.rows.push(Row { first, second });
    }

    fn push(&mut self, coefficients: impl IntoIterator<Item = f64>) -> Range<usize> {
        let start = self.coefficients.len();
        self.coefficients.extend(coefficients);
        start..self.coefficients.len()
    }

    pub(crate) fn nrows(&self) -> usize {
        self.rows.len()
    }

    /// The landmark blocks that it touches, row by row.
    pub(super) fn landmarks(&self) -> impl Iterator<Item = Range<usize>> + '_ {
        let blocks = self.rows.iter().flat_map(|row| [&row.first, &row.second]);
        let touched = blocks.filter(|(offset, coefficients)| *offset > 0 && !coefficients.is_empty());
        touched.map(|(offset, coefficients)| *offset..offset + coefficients.len())
    }

    /// The same rows for a different order of the states: `place` gives the new start of a block.
    pub(super) fn relocated(&self, place: impl Fn(usize) -> usize) -> Self {
        let mut relocated = self.clone();
        for row in &mut relocated.rows {
            row.first.0 = place(row.first.0);
            row.second.0 = place(row.second.0);
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

    /// $`(\sum_i |h_i| \sqrt{P_{ii}})^2`$ of each row: its variance if nothing cancelled.
    pub(super) fn largest_variances(&self, p: &DMatrixView<'_, f64>) -> DVector<f64> {
        let deviation = |(state, coefficient): (usize, f64)| coefficient.abs() * p[(state, state)].sqrt();
        DVector::from_fn(self.nrows(), |row, _| {
            self.entries(&self.rows[row]).map(deviation).sum::<f64>().powi(2)
        })
    }

    fn entries<'a>(&'a self, row: &'a Row) -> impl Iterator<Item = (usize, f64)> + 'a {
        let of = |(offset, range): &Block| (*offset..).zip(self.coefficients[range.clone()].iter().copied());
        of(&row.first).chain(of(&row.second))
    }
}
