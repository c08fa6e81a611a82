use super::{ViewDescriptor, ViewDifference};
use crate::AppearanceMapError;

/// Names a reference view for as long as the map lives.
///
/// ```
/// # use nalgebra::Vector3;
/// # use wayfix_appearance_cml::{AppearanceMap, AppearanceMapParams, PanoramaDescriptor, ReferenceId};
/// # use wayfix_estimation_traits::Pose2;
/// # use wayfix_gaussian_core::Gaussian;
/// # let view = |re: i8| PanoramaDescriptor::from_parts(0.01, 1, vec![3, re, 0]);
/// # let pose = Gaussian::from_sigmas(Pose2::new(1.0, 2.0, 0.0), &Vector3::new(0.1, 0.1, 0.1))?;
/// let mut map: AppearanceMap<PanoramaDescriptor> = AppearanceMap::default();
/// let params = AppearanceMapParams { max_references: 1, ..Default::default() };
/// assert_eq!(map.learn(view(20)?, &pose, &params, 16.3)?.inserted, Some(ReferenceId(0)));
/// let second = map.learn(view(90)?, &pose, &params, 16.3)?;
/// assert_eq!((second.inserted, second.forgotten), (Some(ReferenceId(1)), vec![ReferenceId(0)]));
/// assert_eq!(map.next_id(), 2); // the number 0 is not given again
/// # Ok::<(), wayfix_appearance_cml::AppearanceMapError>(())
/// ```
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord, Hash)]
pub struct ReferenceId(pub u32);

/// A reference view that was found.
///
/// ```
/// use wayfix_appearance_cml::{LinearSearch, PanoramaDescriptor, ReferenceId, ReferenceSearch, similarity};
/// let view = |re: i8| PanoramaDescriptor::from_parts(0.01, 1, vec![3, re, 0]);
/// let mut search = LinearSearch::default();
/// search.insert(ReferenceId(7), view(20)?)?;
/// let found = search.within(&view(30)?, 0.2)[0]; // ten steps of 0.01: half of the limit
/// assert_eq!(found.id, ReferenceId(7));
/// assert!((similarity(found.comparison.distance, 0.2) - 9.0 / 16.0).abs() < 1e-6);
/// # Ok::<(), wayfix_appearance_cml::AppearanceMapError>(())
/// ```
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
///
/// ```
/// # use wayfix_appearance_cml::{AppearanceIndex, LinearSearch, PanoramaDescriptor, ReferenceId, ReferenceSearch};
/// # let view = |re: i8| PanoramaDescriptor::from_parts(0.01, 1, vec![3, re, 0]);
/// let (mut plain, mut index) = (LinearSearch::default(), AppearanceIndex::default());
/// for k in 0..100 {
///     plain.insert(ReferenceId(k), view(k as i8)?)?;
///     index.insert(ReferenceId(k), view(k as i8)?)?;
/// }
/// index.remove(ReferenceId(42));
/// plain.remove(ReferenceId(42));
/// assert_eq!(index.within(&view(40)?, 0.05), plain.within(&view(40)?, 0.05)); // the law, to the bit
/// assert_eq!(plain.within(&view(40)?, 0.035).len(), 6); // 37 to 43 without 42
/// # Ok::<(), wayfix_appearance_cml::AppearanceMapError>(())
/// ```
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
