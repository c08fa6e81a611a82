use std::ops::Range;

use nalgebra::{DMatrix, DMatrixView, DMatrixViewMut, DimName, Matrix3, OMatrix, Storage};

/// Dimension of the robot's block, which comes first.
pub(crate) const ROBOT: usize = 3;

/// A covariance that grows, in a storage that doubles, so that a new landmark seldom moves the matrix.
#[derive(Clone, Debug)]
pub(crate) struct JointCovariance {
    storage: DMatrix<f64>,
    dimension: usize,
}

impl JointCovariance {
    pub(crate) fn from_robot(robot: &Matrix3<f64>) -> Self {
        let mut storage = DMatrix::zeros(16, 16);
        storage.fixed_view_mut::<3, 3>(0, 0).copy_from(robot);
        Self { storage, dimension: ROBOT }
    }

    pub(crate) fn matrix(&self) -> DMatrixView<'_, f64> {
        self.storage.view((0, 0), (self.dimension, self.dimension))
    }

    pub(super) fn matrix_mut(&mut self) -> DMatrixViewMut<'_, f64> {
        self.storage.view_mut((0, 0), (self.dimension, self.dimension))
    }

    pub(crate) fn block(&self, rows: Range<usize>, columns: Range<usize>) -> DMatrixView<'_, f64> {
        self.storage.view((rows.start, columns.start), (rows.len(), columns.len()))
    }

    pub(crate) fn robot(&self) -> Matrix3<f64> {
        self.storage.fixed_view::<3, 3>(0, 0).into_owned()
    }

    /// $`P_{rr} ← F P_{rr} F^T + Q,\; P_{rm} ← F P_{rm}`$, in O(n).
    pub(crate) fn move_robot(&mut self, jacobian: &Matrix3<f64>, noise: &Matrix3<f64>) {
        let robot = jacobian * self.robot() * jacobian.transpose() + noise;
        for column in ROBOT..self.dimension {
            let moved = jacobian * self.storage.fixed_view::<3, 1>(0, column);
            self.storage.fixed_view_mut::<3, 1>(0, column).copy_from(&moved);
            self.storage.fixed_view_mut::<1, 3>(column, 0).copy_from(&moved.transpose());
        }
        self.storage.fixed_view_mut::<3, 3>(0, 0).copy_from(&((robot + robot.transpose()) * 0.5));
    }

    /// Appends a block that depends on the robot: $`P_{m·} = G P_{r·},\; P_{mm} = G P_{rr} G^T + N`$. Returns its offset.
    pub(crate) fn append<L: DimName, SG, SN>(
        &mut self,
        robot_jacobian: &nalgebra::Matrix<f64, L, nalgebra::Const<3>, SG>,
        noise: &nalgebra::Matrix<f64, L, L, SN>,
    ) -> usize
    where
        SG: Storage<f64, L, nalgebra::Const<3>>,
        SN: Storage<f64, L, L>,
        nalgebra::DefaultAllocator: nalgebra::allocator::Allocator<L, L>
            + nalgebra::allocator::Allocator<L, nalgebra::Const<3>>
            + nalgebra::allocator::Allocator<nalgebra::Const<3>, L>
            + nalgebra::allocator::Allocator<L>,
    {
        let (offset, rows) = (self.dimension, noise.nrows());
        self.reserve(offset + rows);
        for column in 0..offset {
            let cross = robot_jacobian * self.storage.fixed_view::<3, 1>(0, column);
            for row in 0..rows {
                self.storage[(offset + row, column)] = cross[row];
                self.storage[(column, offset + row)] = cross[row];
            }
        }
        let own: OMatrix<f64, L, L> = robot_jacobian * self.robot() * robot_jacobian.transpose() + noise;
        let own = (&own + own.transpose()) * 0.5;
        self.storage.view_mut((offset, offset), (rows, rows)).copy_from(&own);
        self.dimension += rows;
        offset
    }

    fn reserve(&mut self, dimension: usize) {
        if dimension > self.storage.nrows() {
            let capacity = dimension.max(2 * self.storage.nrows());
            let mut grown = DMatrix::zeros(capacity, capacity);
            grown.view_mut((0, 0), (self.dimension, self.dimension)).copy_from(&self.matrix());
            self.storage = grown;
        }
    }
}
