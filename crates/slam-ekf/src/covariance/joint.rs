use std::ops::Range;

use nalgebra::{
    Const, DMatrix, DMatrixView, DMatrixViewMut, DefaultAllocator, DimName, OMatrix, OVector,
    allocator::Allocator,
};

use super::ROUNDING;

/// A covariance that grows in a storage that grows by half, so a new landmark rarely moves the matrix. The robot comes first.
#[derive(Clone, Debug)]
pub(crate) struct JointCovariance {
    storage: DMatrix<f64>,
    dimension: usize,
    /// The beginning of the next storage, zeroed in parts with every landmark. Fresh memory pages are the largest cost of a step; this spreads
    /// them over many steps.
    next: Vec<f64>,
}

impl JointCovariance {
    pub(crate) fn from_robot<R: DimName>(robot: &OMatrix<f64, R, R>) -> Self
    where
        DefaultAllocator: Allocator<R, R>,
    {
        let dimension = R::DIM;
        let mut storage = DMatrix::zeros(stride(2 * dimension), 2 * dimension);
        storage.view_mut((0, 0), (dimension, dimension)).copy_from(robot);
        Self { storage, dimension, next: Vec::new() }
    }

    pub(super) fn from_matrix(matrix: DMatrix<f64>) -> Self {
        let dimension = matrix.nrows();
        let mut storage = DMatrix::zeros(stride(dimension), dimension);
        storage.view_mut((0, 0), (dimension, dimension)).copy_from(&matrix);
        Self { storage, dimension, next: Vec::new() }
    }

    pub(crate) fn matrix(&self) -> DMatrixView<'_, f64> {
        self.storage.view((0, 0), (self.dimension, self.dimension))
    }

    pub(super) fn matrix_mut(&mut self) -> DMatrixViewMut<'_, f64> {
        self.storage.view_mut((0, 0), (self.dimension, self.dimension))
    }

    pub(super) fn dimension(&self) -> usize {
        self.dimension
    }

    /// $`P_{mr}`$ and $`P_{mm}`$ of the landmark block at `offset`.
    pub(crate) fn landmark_blocks<L: DimName, R: DimName>(
        &self,
        offset: usize,
    ) -> (OMatrix<f64, L, R>, OMatrix<f64, L, L>)
    where
        DefaultAllocator: Allocator<L, R> + Allocator<L, L>,
    {
        let at = |row: usize, column: usize| self.storage[(offset + row, column)];
        let with_robot = OMatrix::<f64, L, R>::from_fn(&at);
        (with_robot, OMatrix::<f64, L, L>::from_fn(|row, column| at(row, offset + column)))
    }

    pub(crate) fn robot<R: DimName>(&self) -> OMatrix<f64, R, R>
    where
        DefaultAllocator: Allocator<R, R>,
    {
        OMatrix::from_fn(|row, column| self.storage[(row, column)])
    }

    /// $`P_{rr} ← F P_{rr} F^T + Q,\; P_{rm} ← F P_{rm}`$, in O(n). [Andrade-Cetto 2005, Eq. 5]
    pub(crate) fn move_robot<R: DimName>(&mut self, jacobian: &OMatrix<f64, R, R>, noise: &OMatrix<f64, R, R>)
    where
        DefaultAllocator: Allocator<R, R> + Allocator<R>,
    {
        let robot = jacobian * self.robot::<R>() * jacobian.transpose() + noise;
        for column in R::DIM..self.dimension {
            let moved = jacobian * OVector::<f64, R>::from_fn(|row, _| self.storage[(row, column)]);
            for row in 0..R::DIM {
                self.storage[(row, column)] = moved[row];
                self.storage[(column, row)] = moved[row];
            }
        }
        let robot = robot.symmetric_part() + self.rounding(jacobian);
        self.storage.view_mut((0, 0), (R::DIM, R::DIM)).copy_from(&robot);
    }

    /// $`P ← (I + A B S) P (I + A B S)^T`$, where $`S`$ takes the robot out of the state: every block leans by its rows of `A` on $`B e_r`$.
    ///
    /// Cost $`O(n^2)`$ for each column of `A` that is not zero. The rows of the robot must be zero: [`move_robot`](Self::move_robot) moves it.
    pub(crate) fn shear(&mut self, a: &DMatrix<f64>, b: &DMatrix<f64>) {
        let leaned_on = b * self.matrix().rows(0, b.ncols()); // B P_r·
        let own = leaned_on.columns(0, b.ncols()) * b.transpose() * 0.5;
        let half = leaned_on + own * a.transpose();
        let half = half.transpose();
        let mut p = self.storage.view_mut((0, 0), (self.dimension, self.dimension));
        for column in (0..a.ncols()).filter(|column| a.column(*column).amax() > 0.0) {
            let (lean, on) = (a.column(column), half.column(column));
            for (state, mut entries) in p.column_iter_mut().enumerate() {
                let (on_state, lean_state) = (on[state], lean[state]);
                for (entry, (lean, on)) in entries.iter_mut().zip(lean.iter().zip(on.iter())) {
                    *entry += lean * on_state + on * lean_state;
                }
            }
        }
        for state in 0..self.dimension {
            let deviation: f64 = (0..a.ncols()).map(|k| (a[(state, k)] * half[(state, k)]).abs()).sum();
            p[(state, state)] += ROUNDING * (p[(state, state)].abs() + deviation);
        }
    }

    /// Appends a block that depends on the robot: $`P_{m·} = G P_{r·},\; P_{mm} = G P_{rr} G^T + N`$. Returns its offset.
    pub(crate) fn append<L: DimName, R: DimName>(
        &mut self,
        robot_jacobian: &OMatrix<f64, L, R>,
        noise: &OMatrix<f64, L, L>,
    ) -> usize
    where
        DefaultAllocator: Allocator<L, L>
            + Allocator<L, R>
            + Allocator<R, L>
            + Allocator<R, R>
            + Allocator<R>
            + Allocator<L>,
    {
        let offset = self.dimension;
        self.reserve(offset + L::DIM);
        for column in 0..offset {
            let cross =
                robot_jacobian * OMatrix::<f64, R, Const<1>>::from_fn(|row, _| self.storage[(row, column)]);
            for row in 0..L::DIM {
                self.storage[(offset + row, column)] = cross[row];
                self.storage[(column, offset + row)] = cross[row];
            }
        }
        let own = robot_jacobian * self.robot::<R>() * robot_jacobian.transpose() + noise;
        let own = own.symmetric_part() + self.rounding(robot_jacobian);
        self.storage.view_mut((offset, offset), (L::DIM, L::DIM)).copy_from(&own);
        self.dimension += L::DIM;
        offset
    }

    /// Appends rows and columns of zeros.
    pub(super) fn extend_with_zeros(&mut self, n: usize) {
        let (start, end) = (self.dimension, self.dimension + n);
        self.reserve(end);
        self.storage.view_mut((0, start), (end, n)).fill(0.0);
        self.storage.view_mut((start, 0), (n, start)).fill(0.0);
        self.dimension = end;
    }

    /// Removes a block: the remainder is the marginal of the rest.
    pub(crate) fn remove(&mut self, block: Range<usize>) {
        let dimension = self.dimension - block.len();
        let (capacity, n) = (self.storage.nrows(), self.dimension);
        let entries = self.storage.as_mut_slice();
        for column in 0..dimension {
            let source = capacity * if column < block.start { column } else { column + block.len() };
            let target = capacity * column;
            entries.copy_within(source..source + block.start, target); // sources lie behind: never yet overwritten
            entries.copy_within(source + block.end..source + n, target + block.start);
        }
        self.dimension = dimension;
    }

    /// Bound of the rounding error of a product $`J P_{rr} J^T`$ in which large terms cancel.
    fn rounding<D: DimName, R: DimName>(&self, jacobian: &OMatrix<f64, D, R>) -> OMatrix<f64, D, D>
    where
        DefaultAllocator: Allocator<D, D> + Allocator<D, R>,
    {
        let deviation =
            |row: usize, state: usize| jacobian[(row, state)].abs() * self.storage[(state, state)].sqrt();
        let largest_variance =
            |row: usize| (0..R::DIM).map(|state| deviation(row, state)).sum::<f64>().powi(2);
        OMatrix::<f64, D, D>::from_fn(
            |row, column| if row == column { ROUNDING * largest_variance(row) } else { 0.0 },
        )
    }

    /// Makes room for `dimension` states, and prepares part of the next storage.
    fn reserve(&mut self, dimension: usize) {
        let capacity = self.storage.ncols();
        let larger = capacity + capacity.div_ceil(2);
        if dimension > capacity {
            let columns = dimension.max(larger);
            let rows = stride(columns);
            self.next.resize(rows * columns, 0.0);
            let mut grown = DMatrix::from_vec(rows, columns, std::mem::take(&mut self.next));
            grown.view_mut((0, 0), (self.dimension, self.dimension)).copy_from(&self.matrix());
            self.storage = grown;
        } else {
            let n_entries = stride(larger) * larger;
            let n_ready = n_entries * dimension / capacity;
            if n_ready > self.next.len() {
                self.next.reserve_exact(n_entries.saturating_sub(self.next.len()));
                self.next.resize(n_ready, 0.0);
            }
        }
    }
}

/// Rows to store for a matrix of this size: an odd number of cache lines, so that the entries of a row map to different
/// cache sets.
fn stride(dimension: usize) -> usize {
    dimension.next_multiple_of(16) + 8
}

#[cfg(test)]
mod tests {
    use approx::assert_abs_diff_eq;
    use nalgebra::{DMatrix, Matrix2x3, Matrix3};

    use super::*;

    #[test]
    fn a_shear_is_the_dense_congruence() {
        let mut covariance =
            JointCovariance::from_robot(&Matrix3::new(2.0, 0.3, 0.1, 0.3, 1.0, -0.2, 0.1, -0.2, 0.5));
        for k in 0..4 {
            let lever = Matrix2x3::new(1.0, 0.2 * k as f64, -1.0, 0.0, 1.0, 0.5 * k as f64);
            covariance.append(&lever, &nalgebra::Matrix2::new(0.3, 0.1, 0.1, 0.2));
        }
        let before = covariance.matrix().into_owned();
        let n = before.nrows();
        let a = DMatrix::from_fn(
            n,
            2,
            |row, column| if row < 3 { 0.0 } else { ((row + 3 * column) as f64).sin() },
        );
        let b = DMatrix::from_row_slice(2, 3, &[0.5, -1.0, 0.0, 0.1, 0.2, 2.0]);

        covariance.shear(&a, &b);

        let mut dense = DMatrix::identity(n, n);
        dense.columns_mut(0, 3).gemm(1.0, &a, &b, 1.0);
        let expected = &dense * before * dense.transpose();
        assert_abs_diff_eq!(covariance.matrix().into_owned(), expected, epsilon = 1e-12 * expected.amax()); // roundings of a dozen products, and what is given back
        assert_eq!(covariance.matrix(), covariance.matrix().transpose());
    }
}
