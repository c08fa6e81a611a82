use nalgebra::{DefaultAllocator, Dim};
use wayfix_estimation_traits::{Manifold, UpdateAlloc};

use crate::LandmarkModel;

/// Tangent dimension of the robot state of a model.
pub type RobotDim<M> = <<M as LandmarkModel>::Robot as Manifold>::Dim;

/// Tangent dimension of the landmarks of a model.
pub type LandmarkDim<M> = <<M as LandmarkModel>::Landmark as Manifold>::Dim;

/// Tangent dimension of the measurements of a model.
pub type MeasurementDim<M> = <<M as LandmarkModel>::Measurement as Manifold>::Dim;

/// Allocator bound of a landmark model: a robot of dimension `R`, landmarks of dimension `L`, measurements of dimension `Z`.
pub trait SlamAlloc<R: Dim, L: Dim, Z: Dim>:
    UpdateAlloc<L, Z> + UpdateAlloc<R, Z> + UpdateAlloc<L, R>
{
}
impl<R: Dim, L: Dim, Z: Dim> SlamAlloc<R, L, Z> for DefaultAllocator where
    DefaultAllocator: UpdateAlloc<L, Z> + UpdateAlloc<R, Z> + UpdateAlloc<L, R>
{
}
