use super::{ViewDescriptor, ViewDifference};
use crate::AppearanceMapError;

/// Names a reference view for as long as the map lives.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord, Hash)]
pub struct ReferenceId(pub u32);

/// A reference view that was found.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct ReferenceMatch {
    /// Which one.
    pub id: ReferenceId,
    /// Its comparison with the query view.
    pub comparison: ViewDifference,
}

/// Holds the descriptors of all reference views and finds those that are near a view.
///
/// **Law**: whatever the order of insertions and removals, the answers are those of [`LinearSearch`](super::LinearSearch).
pub trait ReferenceSearch<D: ViewDescriptor> {
    /// Takes a reference in.
    ///
    /// # Errors
    /// [`AppearanceMapError::DuplicateReference`] when there is one of that number; an index may refuse a descriptor that cannot be compared
    /// with the others, [`AppearanceMapError::Incomparable`].
    fn insert(&mut self, id: ReferenceId, descriptor: D) -> Result<(), AppearanceMapError>;

    /// Takes a reference out, if there is one of that number.
    fn remove(&mut self, id: ReferenceId) -> Option<D>;

    /// The descriptor of a reference.
    fn get(&self, id: ReferenceId) -> Option<&D>;

    /// How many references there are.
    fn len(&self) -> usize;

    /// Whether there are none.
    fn is_empty(&self) -> bool {
        self.len() == 0
    }

    /// All references nearer than `max_distance`, the nearest first, by number where they are equally near.
    fn within(&self, view: &D, max_distance: f64) -> Vec<ReferenceMatch>;

    /// Those of the candidates that are nearer than `max_distance`, in the order of the candidates; one that is not there is skipped.
    fn within_among(&self, view: &D, candidates: &[ReferenceId], max_distance: f64) -> Vec<ReferenceMatch> {
        let compare =
            |id: &ReferenceId| Some(ReferenceMatch { id: *id, comparison: view.compare(self.get(*id)?) });
        candidates
            .iter()
            .filter_map(compare)
            .filter(|found| found.comparison.distance < max_distance)
            .collect()
    }

    /// The `n` nearest references (all of them where there are fewer), the nearest first, by number where they are equally near.
    fn nearest(&self, view: &D, n: usize) -> Vec<ReferenceMatch>;

    /// The `n` nearest of the references nearer than `max_distance`: [`nearest`](Self::nearest), cut off.
    fn nearest_within(&self, view: &D, n: usize, max_distance: f64) -> Vec<ReferenceMatch> {
        let mut found = self.nearest(view, n);
        found.retain(|found| found.comparison.distance < max_distance);
        found
    }
}
