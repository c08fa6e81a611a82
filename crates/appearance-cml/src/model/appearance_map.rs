use std::collections::BTreeMap;
use std::marker::PhantomData;

use wayfix_estimation_traits::Pose2;
use wayfix_gaussian_core::Gaussian;

use super::grid::Grid;
use super::{
    AppearanceMapParams, PlaceComponent, PlaceMatch, ReferenceView, ViewDifferenceModel, similarity,
};
use crate::{AppearanceMapError, LinearSearch, ReferenceId, ReferenceMatch, ReferenceSearch, ViewDescriptor};

/// The appearance map: reference views, and the poses that each was seen from. [Gross et al. 2005, Eqs. 9–10]
///
/// Plain data: [`search`](Self::search), [`references`](Self::references) and [`scale`](Self::scale) are all there is, and
/// [`from_parts`](Self::from_parts) takes them back.
///
/// ```
/// # use wayfix_appearance_cml::{ViewDifference, ViewDescriptor};
/// # #[derive(Clone, Debug)]
/// # struct Brightness(f64);
/// # impl ViewDescriptor for Brightness {
/// #     fn compare(&self, other: &Self) -> ViewDifference {
/// #         ViewDifference { distance: (self.0 - other.0).abs(), rotation: 0.0 }
/// #     }
/// # }
/// use nalgebra::Vector3;
/// use wayfix_appearance_cml::{AppearanceMap, AppearanceMapParams};
/// use wayfix_estimation_traits::Pose2;
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
    pub(super) scale: ViewDifferenceModel,
    next: u32,
    descriptor: PhantomData<fn() -> D>,
}

/// The area that an empty map is taken to cover, m²: much more than an external position is uncertain by.
const UNKNOWN_AREA: f64 = 1e6;

impl<D: ViewDescriptor, S: ReferenceSearch<D> + Default> Default for AppearanceMap<D, S> {
    fn default() -> Self {
        Self {
            search: S::default(),
            references: BTreeMap::new(),
            grid: Grid::default(),
            scale: ViewDifferenceModel::default(),
            next: 0,
            descriptor: PhantomData,
        }
    }
}

impl<D: ViewDescriptor, S: ReferenceSearch<D>> AppearanceMap<D, S> {
    /// A map from its parts; `next` is the number of the next reference.
    ///
    /// # Errors
    /// Returns an error if a place is invalid ([`ReferenceView::validate`]), and [`AppearanceMapError::NoSuchReference`] if a reference has no view,
    /// no place, or a number that is not below `next`; [`AppearanceMapError::Parameter`] if there are more views than references.
    pub fn from_parts(
        search: S,
        references: BTreeMap<ReferenceId, ReferenceView>,
        scale: ViewDifferenceModel,
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
    /// The places of each view.
    pub fn references(&self) -> &BTreeMap<ReferenceId, ReferenceView> {
        &self.references
    }
    /// The places of one view.
    pub fn reference(&self, id: ReferenceId) -> Option<&ReferenceView> {
        self.references.get(&id)
    }
    /// How views change with distance.
    pub fn scale(&self) -> &ViewDifferenceModel {
        &self.scale
    }
    /// The same, to add samples to.
    pub fn scale_mut(&mut self) -> &mut ViewDifferenceModel {
        &mut self.scale
    }
    /// The number of the next reference.
    pub fn next_id(&self) -> u32 {
        self.next
    }
    /// Number of references.
    pub fn len(&self) -> usize {
        self.references.len()
    }
    /// Whether the map is empty.
    pub fn is_empty(&self) -> bool {
        self.references.is_empty()
    }

    /// $`E^{max}`$.
    pub fn match_limit(&self, params: &AppearanceMapParams) -> f64 {
        self.scale.match_limit(params.max_match_difference_share)
    }

    /// Maximum distance between the places of two matching views, m.
    pub fn match_radius(&self, params: &AppearanceMapParams) -> f64 {
        self.scale.to_meters(self.match_limit(params))
    }

    /// The area with references, m²; at least 1. An empty map counts as a square kilometre, since its extent is unknown.
    pub fn area(&self) -> f64 {
        if self.is_empty() { UNKNOWN_AREA } else { self.grid.area() }
    }

    /// Inserts the view as a reference of this place, for a map that is taught with known poses.
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

    /// Places within the gate of the components of `belief` whose references match the view, and those of the `n_anywhere` most similar
    /// references of the whole map.
    pub fn place_matches(
        &self,
        view: &D,
        belief: &[Gaussian<Pose2<f64>>],
        n_anywhere: usize,
        (params, gate): (&AppearanceMapParams, f64),
    ) -> Vec<PlaceMatch> {
        let limit = self.match_limit(params);
        let mut matches =
            if n_anywhere > 0 { self.search.nearest_within(view, n_anywhere, limit) } else { Vec::new() };
        for component in belief {
            let radius = self.search_radius(component, params, gate).min(self.scale.far_distance());
            matches.extend(self.search.within_among(view, &self.near(component, radius), limit));
        }
        matches.sort_by_key(|m| m.id);
        matches.dedup_by_key(|m| m.id);
        self.places_of(matches, limit)
    }

    /// All places of all matching references of the map. [Gross et al. 2005, Sec. 2.2]
    pub fn all_place_matches(&self, view: &D, params: &AppearanceMapParams) -> Vec<PlaceMatch> {
        let limit = self.match_limit(params);
        self.places_of(self.search.within(view, limit), limit)
    }

    pub(super) fn places_of(&self, matches: Vec<ReferenceMatch>, limit: f64) -> Vec<PlaceMatch> {
        let places = |m: &ReferenceMatch| {
            let places = self.references.get(&m.id).map_or(&[][..], |reference| &reference.places);
            let similarity = similarity(m.comparison.distance, limit);
            places.iter().enumerate().map(|place| PlaceMatch::new(*m, place, similarity)).collect::<Vec<_>>()
        };
        matches.iter().flat_map(places).collect()
    }

    /// All references with a place that may be within `radius` of a belief.
    pub(super) fn near(&self, belief: &Gaussian<Pose2<f64>>, radius: f64) -> Vec<ReferenceId> {
        self.grid.near(&belief.mean().translation, radius)
    }

    /// Distance from the mean of a belief at which references may match, m: the match radius, and the error of the belief within the gate.
    pub(crate) fn search_radius(
        &self,
        belief: &Gaussian<Pose2<f64>>,
        params: &AppearanceMapParams,
        gate: f64,
    ) -> f64 {
        self.match_radius(params) + gate.sqrt() * belief.sigmas().xy().max()
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

    /// Replaces the places of a reference.
    pub(super) fn replace(&mut self, id: ReferenceId, reference: ReferenceView) {
        if let Some(old) = self.references.get_mut(&id) {
            for place in &old.places {
                self.grid.remove(id, &place.gaussian.mean().translation);
            }
            enter(&mut self.grid, id, &reference);
            *old = reference;
        }
    }

    pub(super) fn remove(&mut self, id: ReferenceId) {
        self.replace(id, ReferenceView::default());
        self.references.remove(&id);
        self.search.remove(id);
    }
}

fn enter(grid: &mut Grid, id: ReferenceId, reference: &ReferenceView) {
    for place in &reference.places {
        grid.insert(id, &place.gaussian.mean().translation);
    }
}
