use std::fmt::Debug;

use super::LowerBoundedDistance;

/// Lower bounds of all references, side by side in memory. A search reads them first; their cost is mostly that of reading.
///
/// **Law**: for every `enough`, what is passed over is farther: where [`may_be_within`](Self::may_be_within) says `None`, the distance is above `enough`; and its
/// number never exceeds the distance.
pub trait LowerBoundTable<D: LowerBoundedDistance>: Clone + Debug + Default {
    /// Puts a reference into a slot and replaces the previous one; a new slot is the next one.
    fn put(&mut self, slot: usize, reference: &D);

    /// A lower bound of the distance of a view to the reference in a slot, unless it is above `enough`.
    fn may_be_within(&self, slot: usize, view: &D::Probe, enough: f64) -> Option<f64>;
}

/// Bounds nothing: for descriptors whose distance is as cheap as a bound.
#[derive(Clone, Copy, Debug, Default)]
pub struct NoLowerBoundTable;

impl<D: LowerBoundedDistance> LowerBoundTable<D> for NoLowerBoundTable {
    fn put(&mut self, _: usize, _: &D) {}

    fn may_be_within(&self, _: usize, _: &D::Probe, _: f64) -> Option<f64> {
        Some(0.0)
    }
}
