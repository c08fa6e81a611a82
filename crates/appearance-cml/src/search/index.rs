use std::collections::BTreeMap;

use super::{
    LowerBoundTable, LowerBoundedDistance, ReferenceId, ReferenceMatch, ReferenceSearch,
    nearest::{Candidate, Nearest, by_distance},
};
use crate::AppearanceMapError;

/// Finds what [`LinearSearch`](super::LinearSearch) finds, to the bit, in a fraction of the comparisons.
///
/// Three stages, each a lower bound of the distance that is sharper and dearer than the one before:
/// 1. the first numbers of each view, side by side in memory ([`LowerBoundTable`]);
/// 2. the descriptors' own [`bound`](LowerBoundedDistance::bound), as sharp as need be;
/// 3. the distance itself, with its rotation.
///
/// Descriptors that are not comparable with the first of the map are refused.
///
/// ```
/// use wayfix_appearance_cml::{AppearanceIndex, PanoramaDescriptor, ReferenceId, ReferenceSearch};
/// let view = |height: i8| PanoramaDescriptor::from_parts(0.01, 2, vec![height, -height, 20, 0, 0, 30]);
/// let mut index = AppearanceIndex::default();
/// for height in 0..100 {
///     index.insert(ReferenceId(height as u32), view(height)?)?;
/// }
/// assert_eq!(index.nearest(&view(42)?, 1)[0].id, ReferenceId(42));
/// # Ok::<(), wayfix_appearance_cml::AppearanceMapError>(())
/// ```
#[derive(Clone, Debug)]
pub struct AppearanceIndex<D: LowerBoundedDistance> {
    slots: Vec<Option<(ReferenceId, D)>>,
    free: Vec<u32>,
    slot_of: BTreeMap<ReferenceId, u32>,
    table: D::Table,
}

/// Number of references that each stage of a search compared.
///
/// ```
/// # use wayfix_appearance_cml::{AppearanceIndex, PanoramaDescriptor, ReferenceId, ReferenceSearch};
/// # let view = |height: i8| PanoramaDescriptor::from_parts(0.01, 2, vec![height, -height, 20, 0, 0, 30]);
/// # let mut index = AppearanceIndex::default();
/// for height in 0..100 {
///     index.insert(ReferenceId(height as u32), view(height)?)?;
/// }
/// let (_, cost) = index.nearest_counted(&view(42)?, 1, f64::INFINITY);
/// assert!(cost.compared < 10 && cost.found == 1); // of 100 references
/// # Ok::<(), wayfix_appearance_cml::AppearanceMapError>(())
/// ```
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct SearchStatistics {
    /// References that the table let through; each is then bounded by its descriptor.
    pub bounded: usize,
    /// Compared: what the bound let through.
    pub compared: usize,
    /// Found.
    pub found: usize,
}

/// More than the rounding of distances of double precision: near 0 the root of a difference of two sums makes 1e-8 of 1e-16.
const BOUND_SLACK: f64 = 1e-7;

impl<D: LowerBoundedDistance> Default for AppearanceIndex<D> {
    fn default() -> Self {
        Self { slots: Vec::new(), free: Vec::new(), slot_of: BTreeMap::new(), table: D::Table::default() }
    }
}

impl<D: LowerBoundedDistance> AppearanceIndex<D> {
    /// As [`within`](ReferenceSearch::within), and what it took.
    pub(crate) fn within_counted(
        &self,
        view: &D,
        max_distance: f64,
    ) -> (Vec<ReferenceMatch>, SearchStatistics) {
        let mut cost = SearchStatistics::default();
        let probe = view.probe();
        let radius = max_distance + BOUND_SLACK;
        let mut found = Vec::new();
        for slot in self.comparable(view) {
            if self.table.may_be_within(slot as usize, &probe, radius).is_none() {
                continue;
            }
            cost.bounded += 1;
            let Some((id, reference)) = &self.slots[slot as usize] else { continue };
            if reference.bound(&probe, radius) <= radius {
                cost.compared += 1;
                found.push(ReferenceMatch { id: *id, comparison: reference.compare_with(&probe) });
            }
        }
        found.retain(|found| found.comparison.distance < max_distance);
        found.sort_by(by_distance);
        cost.found = found.len();
        (found, cost)
    }

    /// As [`nearest_within`](ReferenceSearch::nearest_within), and what it took.
    ///
    /// Rough bounds of all come first; then those of the least, and then all whose bounds leave a chance, sharper bounds before distances.
    pub fn nearest_counted(
        &self,
        view: &D,
        n: usize,
        max_distance: f64,
    ) -> (Vec<ReferenceMatch>, SearchStatistics) {
        let mut cost = SearchStatistics::default();
        if n == 0 {
            return (Vec::new(), cost);
        }
        let probe = view.probe();
        let radius = max_distance + BOUND_SLACK;
        let mut candidates = Vec::new();
        for slot in self.comparable(view) {
            let bound = self.table.may_be_within(slot as usize, &probe, radius);
            candidates.extend(bound.map(|bound| Candidate { bound, slot }));
        }
        cost.bounded = candidates.len();

        // Some of the least bounds first: then the radius is small, and the others can be taken as they lie in memory.
        let n_first = (2 * n).min(candidates.len());
        if n_first < candidates.len() {
            candidates.select_nth_unstable_by(n_first, |a, b| b.cmp(a));
        }
        candidates[n_first..].sort_unstable_by_key(|candidate| candidate.slot);
        let mut nearest = Nearest::new(n, max_distance);
        for Candidate { bound, slot } in candidates {
            let radius = nearest.radius() + BOUND_SLACK;
            let Some((id, reference)) = self.slots[slot as usize].as_ref().filter(|_| bound <= radius) else {
                continue;
            };
            if reference.bound(&probe, radius) <= radius {
                cost.compared += 1;
                nearest.extend([ReferenceMatch { id: *id, comparison: reference.compare_with(&probe) }]);
            }
        }
        let found = nearest.into_sorted();
        cost.found = found.len();
        (found, cost)
    }

    /// All slots in their order in memory, free ones too, or none if the map is not comparable with the view.
    fn comparable(&self, view: &D) -> std::ops::Range<u32> {
        let is_comparable = self.references().next().is_some_and(|(_, any)| view.is_comparable(any));
        0..if is_comparable { self.slots.len() as u32 } else { 0 }
    }

    fn references(&self) -> impl Iterator<Item = &(ReferenceId, D)> {
        self.slots.iter().flatten()
    }
}

impl<D: LowerBoundedDistance> ReferenceSearch<D> for AppearanceIndex<D> {
    fn insert(&mut self, id: ReferenceId, descriptor: D) -> Result<(), AppearanceMapError> {
        if self.slot_of.contains_key(&id) {
            return Err(AppearanceMapError::DuplicateReference { id: id.0 });
        }
        if self.references().next().is_some_and(|(_, any)| !descriptor.is_comparable(any)) {
            return Err(AppearanceMapError::Incomparable { id: id.0 });
        }
        let slot = self.free.pop().unwrap_or(self.slots.len() as u32);
        if slot as usize == self.slots.len() {
            self.slots.push(None);
        }
        self.table.put(slot as usize, &descriptor);
        self.slots[slot as usize] = Some((id, descriptor));
        self.slot_of.insert(id, slot);
        Ok(())
    }

    fn remove(&mut self, id: ReferenceId) -> Option<D> {
        let slot = self.slot_of.remove(&id)?;
        let (_, descriptor) = self.slots[slot as usize].take()?;
        self.free.push(slot);
        Some(descriptor)
    }

    fn get(&self, id: ReferenceId) -> Option<&D> {
        let slot = self.slot_of.get(&id)?;
        self.slots[*slot as usize].as_ref().map(|(_, descriptor)| descriptor)
    }

    fn len(&self) -> usize {
        self.slot_of.len()
    }

    fn within(&self, view: &D, max_distance: f64) -> Vec<ReferenceMatch> {
        self.within_counted(view, max_distance).0
    }

    fn within_among(&self, view: &D, candidates: &[ReferenceId], max_distance: f64) -> Vec<ReferenceMatch> {
        let probe = view.probe();
        let radius = max_distance + BOUND_SLACK;
        let compare = |id: &ReferenceId| {
            let reference = self.get(*id).filter(|reference| reference.bound(&probe, radius) <= radius)?;
            Some(ReferenceMatch { id: *id, comparison: reference.compare_with(&probe) })
        };
        candidates
            .iter()
            .filter_map(compare)
            .filter(|found| found.comparison.distance < max_distance)
            .collect()
    }

    fn nearest(&self, view: &D, n: usize) -> Vec<ReferenceMatch> {
        self.nearest_counted(view, n, f64::INFINITY).0
    }

    fn nearest_within(&self, view: &D, n: usize, max_distance: f64) -> Vec<ReferenceMatch> {
        self.nearest_counted(view, n, max_distance).0
    }
}
