use std::collections::BTreeMap;

use super::{
    LowerBoundTable, LowerBoundedDistance, ReferenceId, ReferenceMatch, ReferenceSearch,
    box_tree::BoxTree,
    nearest::{Candidate, Nearest, by_distance},
    projection::{Projection, Sketch},
    slot_set::SlotSet,
};
use crate::AppearanceMapError;

/// Finds what [`LinearSearch`](super::LinearSearch) finds, to the bit, in a fraction of the comparisons.
///
/// Four stages, each a lower bound of the distance that is sharper and dearer than the one before:
/// 1. sixteen numbers a view, the directions in which the invariants of the map spread most, in a tree of boxes: whole branches are passed over;
/// 2. the first numbers of each, side by side in memory ([`LowerBoundTable`](super::LowerBoundTable));
/// 3. the descriptors' own [`bound`](LowerBoundedDistance::bound), as sharp as need be;
/// 4. the distance itself, with its rotation.
///
/// The directions are learned anew when the map has grown eightfold, up to 16 384 references; in between, insertion and removal cost
/// little more than the way down the tree. Descriptors that are not comparable with the first of the map are refused.
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
    projection: Projection,
    tree: BoxTree,
    table: D::Table,
    relearn_at: usize,
}

/// How many references each stage of a search looked at.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct SearchStatistics {
    /// Bounded by their descriptors: what the tree of sketches let through.
    pub bounded: usize,
    /// Compared: what the bound let through.
    pub compared: usize,
    /// Found.
    pub found: usize,
}

/// References from which directions are learned, and the factor of growth after which they are learned anew.
const FIRST_LEARNING: usize = 32;
const GROWTH: usize = 8;
const LAST_LEARNING: usize = 16_384;
const N_SAMPLES: usize = 256;

/// More than the rounding of a sketch of single precision, relative to its numbers.
const SKETCH_SLACK: f64 = 1e-5;
/// More than the rounding of distances of double precision: near 0 the root of a difference of two sums makes 1e-8 of 1e-16.
const BOUND_SLACK: f64 = 1e-7;

impl<D: LowerBoundedDistance> Default for AppearanceIndex<D> {
    fn default() -> Self {
        Self {
            slots: Vec::new(),
            free: Vec::new(),
            slot_of: BTreeMap::new(),
            projection: Projection::learn(&[]),
            tree: BoxTree::default(),
            table: D::Table::default(),
            relearn_at: FIRST_LEARNING,
        }
    }
}

impl<D: LowerBoundedDistance> AppearanceIndex<D> {
    /// As [`within`](ReferenceSearch::within), and what it took.
    pub fn within_counted(&self, view: &D, max_distance: f64) -> (Vec<ReferenceMatch>, SearchStatistics) {
        let mut cost = SearchStatistics::default();
        let probe = view.probe();
        let radius = max_distance + BOUND_SLACK;
        let mut found = Vec::new();
        for slot in self.reached(view, max_distance) {
            cost.bounded += 1;
            if self.table.may_be_within(slot as usize, &probe, radius).is_none() {
                continue;
            }
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
        for slot in self.reached(view, max_distance) {
            cost.bounded += 1;
            let bound = self.table.may_be_within(slot as usize, &probe, radius);
            candidates.extend(bound.map(|bound| Candidate { bound, slot }));
        }

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

    /// The slots whose sketches are within a radius, in their order in memory.
    fn reached(&self, view: &D, radius: f64) -> impl Iterator<Item = u32> {
        let reached = self.sketch_of_comparable(view).map(|sketch| {
            let largest =
                sketch.iter().fold(radius.abs(), |largest, value| largest.max(f64::from(value.abs())));
            let widened = if radius.is_finite() { radius + SKETCH_SLACK * (1.0 + largest) } else { radius };
            self.tree.within(&sketch, widened as f32, self.slots.len())
        });
        reached.into_iter().flat_map(SlotSet::into_slots)
    }

    fn sketch_of_comparable(&self, view: &D) -> Option<Sketch> {
        let any = self.references().next()?;
        view.is_comparable(&any.1).then(|| self.projection.sketch(&view.invariants()))
    }

    fn references(&self) -> impl Iterator<Item = &(ReferenceId, D)> {
        self.slots.iter().flatten()
    }

    /// Directions from references spread evenly over the map, and a tree of new sketches.
    fn relearn(&mut self) {
        let n = self.slot_of.len();
        let samples: Vec<Vec<f64>> = self
            .references()
            .step_by(n.div_ceil(N_SAMPLES))
            .map(|(_, reference)| reference.invariants())
            .collect();
        self.projection = Projection::learn(&samples);
        self.tree = BoxTree::default();
        for (slot, entry) in self.slots.iter().enumerate() {
            if let Some((_, reference)) = entry {
                self.tree.insert(self.projection.sketch(&reference.invariants()), slot as u32);
            }
        }
        self.relearn_at = if n < LAST_LEARNING { n * GROWTH } else { usize::MAX };
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
        let sketch = self.projection.sketch(&descriptor.invariants());
        let slot = self.free.pop().unwrap_or(self.slots.len() as u32);
        if slot as usize == self.slots.len() {
            self.slots.push(None);
        }
        self.table.put(slot as usize, &descriptor);
        self.slots[slot as usize] = Some((id, descriptor));
        self.slot_of.insert(id, slot);
        self.tree.insert(sketch, slot);
        if self.slot_of.len() >= self.relearn_at {
            self.relearn();
        }
        Ok(())
    }

    fn remove(&mut self, id: ReferenceId) -> Option<D> {
        let slot = self.slot_of.remove(&id)?;
        let (_, descriptor) = self.slots[slot as usize].take()?;
        self.tree.remove(&self.projection.sketch(&descriptor.invariants()), slot);
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

    fn nearest(&self, view: &D, n: usize) -> Vec<ReferenceMatch> {
        self.nearest_counted(view, n, f64::INFINITY).0
    }

    fn nearest_within(&self, view: &D, n: usize, max_distance: f64) -> Vec<ReferenceMatch> {
        self.nearest_counted(view, n, max_distance).0
    }
}
