use nalgebra::{Const, DefaultAllocator, Dim, allocator::Allocator};
use wayfix_estimation_traits::{Manifold, UpdateAlloc};

use crate::LandmarkModel;

/// Tangent dimension of the landmarks of a model.
pub type LandmarkDim<M> = <<M as LandmarkModel>::Landmark as Manifold>::Dim;

/// Tangent dimension of the measurements of a model.
pub type MeasurementDim<M> = <<M as LandmarkModel>::Measurement as Manifold>::Dim;

/// Allocator bound of a landmark model: landmarks of dimension `L`, measurements of dimension `Z`, a robot of dimension 3.
pub trait SlamAlloc<L: Dim, Z: Dim>:
    UpdateAlloc<L, Z> + UpdateAlloc<Const<3>, Z> + UpdateAlloc<L, Const<3>> + Allocator<Const<1>, L>
{
}
impl<L: Dim, Z: Dim> SlamAlloc<L, Z> for DefaultAllocator where
    DefaultAllocator:
        UpdateAlloc<L, Z> + UpdateAlloc<Const<3>, Z> + UpdateAlloc<L, Const<3>> + Allocator<Const<1>, L>
{
}
