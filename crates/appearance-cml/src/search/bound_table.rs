use std::fmt::Debug;

use super::LowerBoundedDistance;

/// What a search looks at first of every reference, side by side in memory: what it costs is mostly to read it.
///
/// **Law**: for every `enough`, what is passed over is farther: where [`may_be_within`](Self::may_be_within) says `None`, the distance is above `enough`; and its
/// number never exceeds the distance.
pub trait LowerBoundTable<D: LowerBoundedDistance>: Clone + Debug + Default {
    /// Puts a reference into a slot, in the stead of what was there; a new slot is the next one.
    fn put(&mut self, slot: usize, reference: &D);

    /// A lower bound of the distance of a view to the reference in a slot, unless it is above `enough`.
    fn may_be_within(&self, slot: usize, view: &D::Probe, enough: f64) -> Option<f64>;
}

/// Bounds nothing: for descriptors that are as cheap to compare as to look at.
#[derive(Clone, Copy, Debug, Default)]
pub struct NoLowerBoundTable;

impl<D: LowerBoundedDistance> LowerBoundTable<D> for NoLowerBoundTable {
    fn put(&mut self, _: usize, _: &D) {}

    fn may_be_within(&self, _: usize, _: &D::Probe, _: f64) -> Option<f64> {
        Some(0.0)
    }
}
