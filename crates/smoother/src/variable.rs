use std::{fmt, marker::PhantomData};

use nalgebra::{Const, DefaultAllocator, Dim, OVector, allocator::Allocator};
use wayfix_estimation_traits::Manifold;

/// What can be estimated: every [`Manifold`] over `f64`. Implemented for all of them, never by hand.
pub trait Variable: Manifold<Scalar = f64> + Send + 'static {
    /// Dimension of the tangent space at this value.
    fn tangent_dim(&self) -> usize;
    /// $`x ⊞ δ`$ with $`δ`$ from a slice of [`tangent_dim`](Self::tangent_dim) numbers.
    fn retract_slice(&self, delta: &[f64]) -> Self;
}

impl<X> Variable for X
where
    X: Manifold<Scalar = f64> + Send + 'static,
    DefaultAllocator: Allocator<X::Dim>,
{
    fn tangent_dim(&self) -> usize {
        self.dim().value()
    }
    fn retract_slice(&self, delta: &[f64]) -> Self {
        self.retract(&OVector::<f64, X::Dim>::from_column_slice_generic(self.dim(), Const::<1>, delta))
    }
}

/// A variable of a [`Graph`](crate::Graph), typed by what it holds.
pub struct VariableId<X> {
    /// Number among all variables of the graph.
    pub(crate) index: usize,
    /// Number among the variables of this type.
    pub(crate) slot: usize,
    pub(crate) marker: PhantomData<fn() -> X>,
}

impl<X> VariableId<X> {
    /// Number of the variable in the order of adding, from 0: errors and covariances use it.
    pub fn index(self) -> usize {
        self.index
    }
}

impl<X> Clone for VariableId<X> {
    fn clone(&self) -> Self {
        *self
    }
}
impl<X> Copy for VariableId<X> {}
impl<X> PartialEq for VariableId<X> {
    fn eq(&self, other: &Self) -> bool {
        self.index == other.index
    }
}
impl<X> Eq for VariableId<X> {}
impl<X> fmt::Debug for VariableId<X> {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(f, "variable {}", self.index)
    }
}
