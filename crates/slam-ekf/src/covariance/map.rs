use std::ops::Range;

use nalgebra::{DMatrix, DVector, DefaultAllocator, DimName, OMatrix, OVector, allocator::Allocator};

use super::{JointCovariance, SparseJacobian, compressed::CompressedCovariance};
use crate::CovarianceUpdate;

/// The joint covariance of robot and map in either form, as the filter uses it.
#[derive(Clone, Debug)]
pub(crate) enum MapCovariance {
    Full(JointCovariance),
    Compressed(Box<CompressedCovariance>),
}

impl MapCovariance {
    pub(crate) fn from_robot<R: DimName>(form: CovarianceUpdate, robot: &OMatrix<f64, R, R>) -> Self
    where
        DefaultAllocator: Allocator<R, R>,
    {
        match form {
            CovarianceUpdate::Full => Self::Full(JointCovariance::from_robot(robot)),
            CovarianceUpdate::Compressed => {
                Self::Compressed(Box::new(CompressedCovariance::from_robot(robot)))
            }
        }
    }

    /// A whole matrix, of which the first `n_robot` rows are the robot's.
    pub(crate) fn from_matrix(form: CovarianceUpdate, n_robot: usize, matrix: DMatrix<f64>) -> Self {
        match form {
            CovarianceUpdate::Full => Self::Full(JointCovariance::from_matrix(matrix)),
            CovarianceUpdate::Compressed => {
                Self::Compressed(Box::new(CompressedCovariance::from_matrix(n_robot, matrix)))
            }
        }
    }

    /// Covariance of two states, given by their rows of the matrix.
    pub(crate) fn entry(&self, one: usize, other: usize) -> f64 {
        match self {
            Self::Full(full) => full.matrix()[(one, other)],
            Self::Compressed(compressed) => compressed.entry(one, other),
        }
    }

    /// [`JointCovariance::shear`]. A compressed map does not support it; the filter refuses this combination.
    pub(crate) fn shear(&mut self, a: &DMatrix<f64>, b: &DMatrix<f64>) {
        if let Self::Full(full) = self {
            full.shear(a, b);
        }
    }

    /// The whole matrix, robot first.
    pub(crate) fn matrix(&self) -> DMatrix<f64> {
        match self {
            Self::Full(full) => full.matrix().into_owned(),
            Self::Compressed(compressed) => compressed.matrix(),
        }
    }

    pub(crate) fn robot<R: DimName>(&self) -> OMatrix<f64, R, R>
    where
        DefaultAllocator: Allocator<R, R>,
    {
        match self {
            Self::Full(full) => full.robot(),
            Self::Compressed(compressed) => compressed.robot(),
        }
    }

    /// $`P_{mr}`$ and $`P_{mm}`$ of the landmark block at `offset`.
    pub(crate) fn landmark_blocks<L: DimName, R: DimName>(
        &self,
        offset: usize,
    ) -> (OMatrix<f64, L, R>, OMatrix<f64, L, L>)
    where
        DefaultAllocator: Allocator<L, R> + Allocator<L, L>,
    {
        match self {
            Self::Full(full) => full.landmark_blocks(offset),
            Self::Compressed(compressed) => compressed.landmark_blocks(offset),
        }
    }

    /// The deferred step of the filter's mean of the landmark block at `offset`; `None` if there is none.
    pub(crate) fn deferred_step<L: DimName>(&self, offset: usize) -> Option<OVector<f64, L>>
    where
        DefaultAllocator: Allocator<L>,
    {
        match self {
            Self::Full(_) => None,
            Self::Compressed(compressed) => compressed.deferred_step(offset),
        }
    }

    /// [`JointCovariance::move_robot`].
    pub(crate) fn move_robot<R: DimName>(&mut self, jacobian: &OMatrix<f64, R, R>, noise: &OMatrix<f64, R, R>)
    where
        DefaultAllocator: Allocator<R, R> + Allocator<R>,
    {
        match self {
            Self::Full(full) => full.move_robot(jacobian, noise),
            Self::Compressed(compressed) => compressed.move_robot(jacobian, noise),
        }
    }

    /// [`JointCovariance::append`].
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
        match self {
            Self::Full(full) => full.append(robot_jacobian, noise),
            Self::Compressed(compressed) => compressed.append(robot_jacobian, noise),
        }
    }

    /// [`JointCovariance::remove`].
    pub(crate) fn remove(&mut self, block: Range<usize>) {
        match self {
            Self::Full(full) => full.remove(block),
            Self::Compressed(compressed) => compressed.remove(block),
        }
    }

    /// [`JointCovariance::correct`]. Returns the step of the means.
    pub(crate) fn correct(
        &mut self,
        jacobian: &SparseJacobian,
        noise: &DMatrix<f64>,
        residual: &DVector<f64>,
    ) -> Option<DVector<f64>> {
        match self {
            Self::Full(full) => full.correct(jacobian, noise, residual),
            Self::Compressed(compressed) => compressed.correct(jacobian, noise, residual),
        }
    }

    /// Marks the end of a scan: deferred work is done now. No value changes.
    pub(crate) fn end_update(&mut self) {
        if let Self::Compressed(compressed) = self {
            compressed.end_update();
        }
    }
}
