use nalgebra::{DefaultAllocator, Dim, allocator::Allocator};

/// Allocator bound for a state of dimension `D`: vectors and square matrices.
///
/// Supertraits are implied where `where` clauses are not, so one line, `DefaultAllocator: StateAlloc<D>`,
/// stands for all of them.
pub trait StateAlloc<D: Dim>: Allocator<D> + Allocator<D, D> {}
impl<D: Dim> StateAlloc<D> for DefaultAllocator where DefaultAllocator: Allocator<D> + Allocator<D, D> {}

/// Allocator bound for updating a state of dimension `D` with a measurement of dimension `M`.
pub trait UpdateAlloc<D: Dim, M: Dim>:
    StateAlloc<D> + StateAlloc<M> + Allocator<D, M> + Allocator<M, D>
{
}
impl<D: Dim, M: Dim> UpdateAlloc<D, M> for DefaultAllocator where
    DefaultAllocator: StateAlloc<D> + StateAlloc<M> + Allocator<D, M> + Allocator<M, D>
{
}
