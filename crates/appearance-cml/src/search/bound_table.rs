use std::fmt::Debug;

use super::LowerBoundedDistance;

/// Lower bounds of all references, side by side in memory. A search reads them first; their cost is mostly that of reading.
///
/// **Law**: for every `enough`, what is passed over is farther: where [`may_be_within`](Self::may_be_within) says `None`, the distance is above `enough`; and its
/// number never exceeds the distance.
///
/// ```
/// # use wayfix_appearance_cml::{LowerBoundTable, LowerBoundedDistance, PanoramaDescriptor, PanoramaLowerBoundTable, ViewDescriptor};
/// # let view = |re: i8| PanoramaDescriptor::from_parts(0.01, 1, vec![3, re, 0]);
/// let (seen, mut table) = (view(50)?, PanoramaLowerBoundTable::default());
/// for (slot, reference) in [view(10)?, view(30)?, view(50)?].iter().enumerate() {
///     table.put(slot, reference);
///     let distance = seen.compare(reference).distance;
///     for enough in [0.0, 0.1, 0.3, f64::INFINITY] {
///         let bound = table.may_be_within(slot, &seen.probe(), enough);
///         assert!(bound.map_or(distance > enough, |bound| bound <= distance)); // the law
///     }
/// }
/// # Ok::<(), wayfix_appearance_cml::AppearanceMapError>(())
/// ```
pub trait LowerBoundTable<D: LowerBoundedDistance>: Clone + Debug + Default {
    /// Puts a reference into a slot and replaces the previous one; a new slot is the next one.
    fn put(&mut self, slot: usize, reference: &D);

    /// A lower bound of the distance of a view to the reference in a slot, unless it is above `enough`.
    fn may_be_within(&self, slot: usize, view: &D::Probe, enough: f64) -> Option<f64>;
}

/// Bounds nothing: for descriptors whose distance is as cheap as a bound.
///
/// ```
/// # use wayfix_appearance_cml::{LowerBoundTable, LowerBoundedDistance, WithoutLowerBounds, PanoramaDescriptor};
/// let probe = PanoramaDescriptor::from_parts(0.01, 1, vec![3, 20, 0])?.probe();
/// // 0 is below every distance, and no reference is passed over.
/// let bound = LowerBoundTable::<PanoramaDescriptor>::may_be_within(&WithoutLowerBounds, 0, &probe, 0.0);
/// assert_eq!(bound, Some(0.0));
/// # Ok::<(), wayfix_appearance_cml::AppearanceMapError>(())
/// ```
#[derive(Clone, Copy, Debug, Default)]
pub struct WithoutLowerBounds;

impl<D: LowerBoundedDistance> LowerBoundTable<D> for WithoutLowerBounds {
    fn put(&mut self, _: usize, _: &D) {}

    fn may_be_within(&self, _: usize, _: &D::Probe, _: f64) -> Option<f64> {
        Some(0.0)
    }
}
