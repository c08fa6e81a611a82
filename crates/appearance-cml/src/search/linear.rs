use std::collections::BTreeMap;

use super::{ReferenceId, ReferenceMatch, ReferenceSearch, ViewDescriptor, nearest::by_distance};
use crate::AppearanceMapError;

/// Compares with every reference: the plain search that faster ones must agree with.
///
/// ```
/// use wayfix_appearance_cml::{LinearSearch, PanoramaDescriptor, ReferenceId, ReferenceSearch};
/// let view = |re: i8| PanoramaDescriptor::from_parts(0.01, 1, vec![3, re, 0]);
/// let mut search = LinearSearch::default();
/// for (id, re) in [(2, 20), (0, 50), (1, 20)] {
///     search.insert(ReferenceId(id), view(re)?)?;
/// }
/// let found: Vec<ReferenceId> = search.nearest(&view(30)?, 3).iter().map(|found| found.id).collect();
/// assert_eq!(found, [1, 2, 0].map(ReferenceId)); // equally near ones by number
/// # Ok::<(), wayfix_appearance_cml::AppearanceMapError>(())
/// ```
#[derive(Clone, Debug)]
pub struct LinearSearch<D> {
    references: BTreeMap<ReferenceId, D>,
}

impl<D> Default for LinearSearch<D> {
    fn default() -> Self {
        Self { references: BTreeMap::new() }
    }
}

impl<D: ViewDescriptor> LinearSearch<D> {
    fn sorted(&self, view: &D, max_distance: f64) -> Vec<ReferenceMatch> {
        let compare = |(id, reference): (&ReferenceId, &D)| ReferenceMatch {
            id: *id,
            comparison: view.compare(reference),
        };
        let mut found: Vec<ReferenceMatch> = self.references.iter().map(compare).collect();
        found.retain(|found| found.comparison.distance < max_distance);
        found.sort_by(by_distance);
        found
    }
}

impl<D: ViewDescriptor> ReferenceSearch<D> for LinearSearch<D> {
    fn insert(&mut self, id: ReferenceId, descriptor: D) -> Result<(), AppearanceMapError> {
        if self.references.contains_key(&id) {
            return Err(AppearanceMapError::DuplicateReference { id: id.0 });
        }
        self.references.insert(id, descriptor);
        Ok(())
    }

    fn remove(&mut self, id: ReferenceId) -> Option<D> {
        self.references.remove(&id)
    }

    fn get(&self, id: ReferenceId) -> Option<&D> {
        self.references.get(&id)
    }

    fn len(&self) -> usize {
        self.references.len()
    }

    fn within(&self, view: &D, max_distance: f64) -> Vec<ReferenceMatch> {
        self.sorted(view, max_distance)
    }

    fn nearest(&self, view: &D, n: usize) -> Vec<ReferenceMatch> {
        let mut found = self.sorted(view, f64::INFINITY);
        found.truncate(n);
        found
    }
}
