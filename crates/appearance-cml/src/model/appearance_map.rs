use std::collections::BTreeMap;
use std::marker::PhantomData;

use wayfix_estimation_traits::{LieGroup, Pose2};
use wayfix_gaussian_core::Gaussian;

use super::grid::Grid;
use super::{AppearanceMapParams, PlaceComponent, PlaceMatch, ReferenceView, ViewDistanceScale, similarity};
use crate::{AppearanceMapError, Descriptor, LinearSearch, ReferenceId, ReferenceMatch, ReferenceSearch};

/// What places look like: reference views and where each was seen. [Gross et al. 2005, Eqs. 9-10]
///
/// Plain data: [`search`](Self::search), [`references`](Self::references) and [`scale`](Self::scale) are all there is, and
/// [`from_parts`](Self::from_parts) takes them back.
///
/// ```
/// # use wayfix_appearance_cml::{ViewDifference, Descriptor};
/// # #[derive(Clone, Debug)]
/// # struct Brightness(f64);
/// # impl Descriptor for Brightness {
/// #     fn compare(&self, other: &Self) -> ViewDifference {
/// #         ViewDifference { distance: (self.0 - other.0).abs(), rotation: 0.0 }
/// #     }
/// # }
/// use nalgebra::Vector3;
/// use wayfix_appearance_cml::{AppearanceMap, AppearanceMapParams};
/// use wayfix_estimation_traits::{LieGroup, Pose2};
/// use wayfix_gaussian_core::Gaussian;
/// let mut map: AppearanceMap<Brightness> = AppearanceMap::default();
/// let pose = Gaussian::from_sigmas(Pose2::new(1.0, 2.0, 0.0), &Vector3::new(0.1, 0.1, 0.05))?;
/// let id = map.teach(Brightness(0.7), &pose)?;
/// assert_eq!(map.reference(id).map(|r| r.places[0].gaussian.mean().x()), Some(1.0));
/// # Ok::<(), wayfix_appearance_cml::AppearanceMapError>(())
/// ```
#[derive(Clone, Debug)]
pub struct AppearanceMap<D, S = LinearSearch<D>> {
    pub(super) search: S,
    references: BTreeMap<ReferenceId, ReferenceView>,
    pub(super) grid: Grid,
    pub(super) scale: ViewDistanceScale,
    next: u32,
    descriptor: PhantomData<fn() -> D>,
}

impl<D: Descriptor, S: ReferenceSearch<D> + Default> Default for AppearanceMap<D, S> {
    fn default() -> Self {
        Self {
            search: S::default(),
            references: BTreeMap::new(),
            grid: Grid::default(),
            scale: ViewDistanceScale::default(),
            next: 0,
            descriptor: PhantomData,
        }
    }
}

impl<D: Descriptor, S: ReferenceSearch<D>> AppearanceMap<D, S> {
    /// A map from its parts; `next` is the number of the next reference.
    ///
    /// # Errors
    /// Returns an error if a place is invalid ([`ReferenceView::validate`]), and [`AppearanceMapError::NoSuchReference`] if a reference has no view,
    /// no place, or a number that is not below `next`; [`AppearanceMapError::Parameter`] if there are more views than references.
    pub fn from_parts(
        search: S,
        references: BTreeMap<ReferenceId, ReferenceView>,
        scale: ViewDistanceScale,
        next: u32,
    ) -> Result<Self, AppearanceMapError> {
        let mut grid = Grid::default();
        for (id, reference) in &references {
            reference.validate()?;
            if search.get(*id).is_none() || id.0 >= next || reference.places.is_empty() {
                return Err(AppearanceMapError::NoSuchReference { id: id.0 });
            }
            enter(&mut grid, *id, reference);
        }
        if search.len() != references.len() {
            return Err(AppearanceMapError::Parameter {
                what: "number of views",
                value: search.len() as f64,
                range: "that of the references",
            });
        }
        Ok(Self { search, references, grid, scale, next, descriptor: PhantomData })
    }

    /// The views.
    pub fn search(&self) -> &S {
        &self.search
    }
    /// Where each was seen.
    pub fn references(&self) -> &BTreeMap<ReferenceId, ReferenceView> {
        &self.references
    }
    /// Where one was seen.
    pub fn reference(&self, id: ReferenceId) -> Option<&ReferenceView> {
        self.references.get(&id)
    }
    /// How views change with the way.
    pub fn scale(&self) -> &ViewDistanceScale {
        &self.scale
    }
    /// The same, to add samples to.
    pub fn scale_mut(&mut self) -> &mut ViewDistanceScale {
        &mut self.scale
    }
    /// The number of the next reference.
    pub fn next_id(&self) -> u32 {
        self.next
    }
    /// How many references.
    pub fn len(&self) -> usize {
        self.references.len()
    }
    /// Whether nothing is learned yet.
    pub fn is_empty(&self) -> bool {
        self.references.is_empty()
    }

    /// $`E^{max}`$: given, or found from the data.
    pub fn match_limit(&self, params: &AppearanceMapParams) -> f64 {
        params.match_limit.unwrap_or_else(|| self.scale.match_limit(params.match_limit_fraction))
    }

    /// How far apart two views may be taken and still match, m.
    pub fn match_radius(&self, params: &AppearanceMapParams) -> f64 {
        self.scale.to_meters(self.match_limit(params))
    }

    /// Makes the view a reference of this place, whatever is there already: for a map that is taught with known poses.
    ///
    /// # Errors
    /// Returns [`AppearanceMapError::Gaussian`] if the pose is invalid, and [`AppearanceMapError::ReferenceIdsExhausted`] if no number is left.
    pub fn teach(&mut self, view: D, pose: &Gaussian<Pose2<f64>>) -> Result<ReferenceId, AppearanceMapError> {
        let gaussian = Gaussian::new(*pose.mean(), *pose.covariance())?;
        self.insert(
            view,
            ReferenceView { places: vec![PlaceComponent { weight: 1.0, count: 1.0, gaussian }] },
        )
    }

    /// Places near the components of `belief` whose references are nearer to the view than `limit`.
    pub fn place_matches_near(
        &self,
        view: &D,
        belief: &[Gaussian<Pose2<f64>>],
        limit: f64,
    ) -> Vec<PlaceMatch> {
        let near = belief.iter().flat_map(|component| self.compare_near(view, component, limit));
        self.places_of(once_each(near.collect()), limit)
    }

    /// Places near the components of `belief`, and those of the `most` references of the whole map that look most like the view, all nearer than `limit`.
    pub fn place_matches_anywhere(
        &self,
        view: &D,
        belief: &[Gaussian<Pose2<f64>>],
        most: usize,
        limit: f64,
    ) -> Vec<PlaceMatch> {
        let mut matches = self.search.nearest_within(view, most, limit);
        matches.extend(belief.iter().flat_map(|component| self.compare_near(view, component, limit)));
        self.places_of(once_each(matches), limit)
    }

    /// All places of all references that look like the view, as printed.
    pub fn all_place_matches(&self, view: &D, params: &AppearanceMapParams) -> Vec<PlaceMatch> {
        let limit = self.match_limit(params);
        self.places_of(self.search.within(view, limit), limit)
    }

    fn places_of(&self, matches: Vec<ReferenceMatch>, limit: f64) -> Vec<PlaceMatch> {
        let places = |m: &ReferenceMatch| {
            let places = self.references.get(&m.id).map_or(&[][..], |reference| &reference.places);
            let similarity = similarity(m.comparison.distance, limit);
            places.iter().enumerate().map(|place| PlaceMatch::new(*m, place, similarity)).collect::<Vec<_>>()
        };
        matches.iter().flat_map(places).collect()
    }

    /// How the view compares with the references near a belief, those below the limit.
    fn compare_near(&self, view: &D, near: &Gaussian<Pose2<f64>>, limit: f64) -> Vec<ReferenceMatch> {
        let mut matches = self.compare_within(view, near, self.search_radius(near, limit));
        matches.retain(|m| m.comparison.distance < limit);
        matches
    }

    /// How the view compares with all references within `radius` of a belief.
    pub(super) fn compare_within(
        &self,
        view: &D,
        near: &Gaussian<Pose2<f64>>,
        radius: f64,
    ) -> Vec<ReferenceMatch> {
        let compare = |id: ReferenceId| {
            self.search.get(id).map(|reference| ReferenceMatch { id, comparison: view.compare(reference) })
        };
        self.grid.near(&near.mean().translation, radius).into_iter().filter_map(compare).collect()
    }

    /// How far from a belief views may match: as far as the limit reaches, and the belief errs.
    pub(super) fn search_radius(&self, near: &Gaussian<Pose2<f64>>, limit: f64) -> f64 {
        let sigmas = near.sigmas();
        self.scale.to_meters(limit) + GATE_SIGMAS * sigmas.x.max(sigmas.y).min(MOST_SIGMA)
    }

    pub(super) fn insert(
        &mut self,
        view: D,
        reference: ReferenceView,
    ) -> Result<ReferenceId, AppearanceMapError> {
        let id = ReferenceId(self.next);
        let next = self.next.checked_add(1).ok_or(AppearanceMapError::ReferenceIdsExhausted)?;
        self.search.insert(id, view)?;
        self.next = next;
        enter(&mut self.grid, id, &reference);
        self.references.insert(id, reference);
        Ok(id)
    }

    /// Puts new places in the stead of old ones.
    pub(super) fn replace(&mut self, id: ReferenceId, reference: ReferenceView) {
        if let Some(old) = self.references.get_mut(&id) {
            for place in &old.places {
                self.grid.remove(id, &place.gaussian.mean().translation);
            }
            enter(&mut self.grid, id, &reference);
            *old = reference;
        }
    }

    /// Carries the places of a reference along with the pose that it was made at, from `before` to `after`.
    pub(crate) fn revise(&mut self, id: ReferenceId, before: &Pose2<f64>, after: &Gaussian<Pose2<f64>>) {
        let Some(reference) = self.references.get(&id) else { return };
        let mut reference = reference.clone();
        for place in &mut reference.places {
            let mean = after.mean().compose(&before.inverse().compose(place.gaussian.mean()));
            let learned = after.in_chart_at(&mean).map(|seen| *seen.covariance());
            let narrower =
                learned.ok().filter(|c| c.determinant() < place.gaussian.covariance().determinant());
            let covariance = narrower.unwrap_or(*place.gaussian.covariance());
            place.gaussian = Gaussian::from_parts_unchecked(mean, covariance);
        }
        self.replace(id, reference);
    }

    pub(super) fn remove(&mut self, id: ReferenceId) {
        self.replace(id, ReferenceView::default());
        self.references.remove(&id);
        self.search.remove(id);
    }
}

fn once_each(mut matches: Vec<ReferenceMatch>) -> Vec<ReferenceMatch> {
    matches.sort_by_key(|m| m.id);
    matches.dedup_by_key(|m| m.id);
    matches
}

/// σ of a belief within which references are compared one by one.
const GATE_SIGMAS: f64 = 3.0;
/// σ beyond which a belief says nothing that the search of the whole map does not say better, m.
const MOST_SIGMA: f64 = 1.0;

fn enter(grid: &mut Grid, id: ReferenceId, reference: &ReferenceView) {
    for place in &reference.places {
        grid.insert(id, &place.gaussian.mean().translation);
    }
}
