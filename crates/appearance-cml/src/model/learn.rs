use std::collections::BTreeMap;

use wayfix_estimation_traits::Pose2;
use wayfix_gaussian_core::Gaussian;

use super::comparing::place_match::turned;
use super::merge::merge_places;
use super::residual::Residual;
use super::weigh::{weight_when_missed, weight_when_seen};
use super::{
    AppearanceMap, AppearanceMapParams, ForgettingMode, PlaceComponent, PlaceUpdateRule, ReferenceView,
    interpolate,
};
use crate::{
    AppearanceMapError, ReferenceId, ReferenceMatch, ReferenceSearch, ViewDescriptor, separation_squared,
    similarity,
};

/// The changes of the map by one view.
///
/// ```
/// # use nalgebra::Vector3;
/// # use wayfix_appearance_cml::{AppearanceMap, AppearanceMapParams, MapUpdate, PanoramaDescriptor, ReferenceId, ViewDifferenceSample};
/// # use wayfix_estimation_traits::Pose2;
/// # use wayfix_gaussian_core::Gaussian;
/// # let view = || PanoramaDescriptor::from_parts(0.01, 1, vec![3, 20, 0]);
/// # let pose = Gaussian::from_sigmas(Pose2::new(1.0, 2.0, 0.0), &Vector3::new(0.1, 0.1, 0.1))?;
/// # let (mut map, params): (AppearanceMap<PanoramaDescriptor>, _) = (AppearanceMap::default(), AppearanceMapParams::default());
/// # map.scale_mut().add_near(ViewDifferenceSample { lag: 0.25, distance: 0.1 });
/// let first = map.learn(view()?, &pose, &params, 16.3)?;
/// assert_eq!(first, MapUpdate { inserted: Some(ReferenceId(0)), forgotten: vec![], matched: 0 });
/// let again = map.learn(view()?, &pose, &params, 16.3)?; // the reference matches: no second one
/// assert_eq!(again, MapUpdate { inserted: None, forgotten: vec![], matched: 1 });
/// # Ok::<(), wayfix_appearance_cml::AppearanceMapError>(())
/// ```
#[derive(Clone, Debug, PartialEq, Eq, Default)]
pub struct MapUpdate {
    /// The new reference, if the view became one.
    pub inserted: Option<ReferenceId>,
    /// References that were removed.
    pub forgotten: Vec<ReferenceId>,
    /// Number of references that matched.
    pub matched: usize,
}

impl<D: ViewDescriptor, S: ReferenceSearch<D>> AppearanceMap<D, S> {
    /// Learns that the view was seen from this pose. [Gross et al. 2005, Sec. 2.3, Fig. 3]
    ///
    /// The three steps of the paper: insertion of a new reference if none matches; update of the places of matching references;
    /// adaptation of the weights. `gate` is [`MixtureFusionParams::gate`](crate::MixtureFusionParams::gate).
    ///
    /// # Errors
    /// Returns [`AppearanceMapError::Gaussian`] if the pose is invalid, and [`AppearanceMapError::ReferenceIdsExhausted`] if no number is left;
    /// the map is then unchanged.
    pub fn learn(
        &mut self,
        view: D,
        pose: &Gaussian<Pose2<f64>>,
        params: &AppearanceMapParams,
        gate: f64,
    ) -> Result<MapUpdate, AppearanceMapError> {
        let pose = &Gaussian::new(*pose.mean(), *pose.covariance())?;
        let limit = self.match_limit(params);
        let radius = self.search_radius(pose, params, gate).min(self.scale().far_distance());
        let here = self.near(pose, radius);
        let seen = match params.place_update {
            PlaceUpdateRule::Pose => self.search().within(&view, limit),
            PlaceUpdateRule::Residual => self.search().within_among(&view, &here, limit),
        };
        let novel = self.is_novel(&seen, limit, params);
        let mut changed = self.with_places_updated(&seen, pose, novel, (limit, params, gate))?;
        self.weigh_seen(&mut changed, &seen, pose, (limit, params, gate))?;
        if params.forgetting_mode == ForgettingMode::Active {
            let missed = here.into_iter().filter(|id| !changed.contains_key(id)).collect();
            self.weigh_missed(&mut changed, missed, pose, params);
        }
        let matched = seen.len();
        let inserted = if novel { Some(self.insert(view, first_seen(pose, params))?) } else { None };
        let mut forgotten = self.commit(changed, params.min_weight);
        forgotten.extend(self.shrink(params.max_references, inserted));
        Ok(MapUpdate { inserted, forgotten, matched })
    }

    /// Step 1: no reference is nearer than $`E^{max}`$, or, with [`PlaceUpdateRule::Residual`], than successive views are to one another.
    fn is_novel(&self, seen: &[ReferenceMatch], limit: f64, params: &AppearanceMapParams) -> bool {
        let insertion = match params.place_update {
            PlaceUpdateRule::Pose => limit,
            PlaceUpdateRule::Residual => limit.min(self.scale().step_distance()),
        };
        !seen.iter().any(|m| m.comparison.distance < insertion)
    }

    /// Step 2: adds a Gaussian to each matching reference. [Gross et al. 2005, Eqs. 11–14]
    fn with_places_updated(
        &self,
        seen: &[ReferenceMatch],
        pose: &Gaussian<Pose2<f64>>,
        novel: bool,
        (limit, params, gate): (f64, &AppearanceMapParams, f64),
    ) -> Result<BTreeMap<ReferenceId, ReferenceView>, AppearanceMapError> {
        // A new reference is as similar to its view as can be, and takes its share of the counts.
        let own = if novel { 1.0 } else { 0.0 };
        let total: f64 = own + seen.iter().map(|m| similarity(m.comparison.distance, limit)).sum::<f64>();
        let residual = match params.place_update {
            PlaceUpdateRule::Pose => None,
            PlaceUpdateRule::Residual => self.residual(seen, pose, (limit, gate))?,
        };
        let mut changed = BTreeMap::new();
        for matched in seen {
            let Some(reference) = self.reference(matched.id) else { continue };
            let mut reference = reference.clone();
            let count = similarity(matched.comparison.distance, limit) / total;
            match (params.place_update, &residual) {
                (PlaceUpdateRule::Pose, _) => {
                    let seen_from = turned(pose, -matched.comparison.rotation);
                    reference.places.push(PlaceComponent { weight: 0.0, count, gaussian: seen_from });
                    merge_places(&mut reference.places, params, gate)?;
                }
                (PlaceUpdateRule::Residual, Some(residual)) => {
                    for place in &mut reference.places {
                        residual.correct(place, matched, count, (pose, params))?;
                    }
                }
                (PlaceUpdateRule::Residual, None) => {}
            }
            changed.insert(matched.id, reference);
        }
        Ok(changed)
    }

    /// The pose minus the pose that the matching places give; `None` if they indicate another place.
    fn residual(
        &self,
        seen: &[ReferenceMatch],
        pose: &Gaussian<Pose2<f64>>,
        (limit, gate): (f64, f64),
    ) -> Result<Option<Residual>, AppearanceMapError> {
        let place_matches = self.places_of(seen.to_vec(), limit);
        let mut nearest = None;
        let mut least = gate;
        for hypothesis in interpolate(&place_matches, std::slice::from_ref(pose), self.scale())? {
            let squared = separation_squared(pose, &hypothesis.gaussian)?;
            if squared < least {
                least = squared;
                let mean = hypothesis.gaussian.mean();
                nearest = Some(Residual {
                    translation: pose.mean().translation - mean.translation,
                    turn: pose.mean().heading() - mean.heading(),
                });
            }
        }
        Ok(nearest)
    }

    /// Step 3, matching references. [Gross et al. 2005, Eqs. 15–17]
    fn weigh_seen(
        &self,
        changed: &mut BTreeMap<ReferenceId, ReferenceView>,
        seen: &[ReferenceMatch],
        pose: &Gaussian<Pose2<f64>>,
        (limit, params, gate): (f64, &AppearanceMapParams, f64),
    ) -> Result<(), AppearanceMapError> {
        for matched in seen {
            let Some(reference) = changed.get_mut(&matched.id) else { continue };
            for place in &mut reference.places {
                place.weight = weight_when_seen(place, matched, pose, (limit, gate), (self.scale(), params))?;
            }
        }
        Ok(())
    }

    /// Step 3, references of this place that do not match. [Gross et al. 2005, Eqs. 18–19]
    fn weigh_missed(
        &self,
        changed: &mut BTreeMap<ReferenceId, ReferenceView>,
        missed: Vec<ReferenceId>,
        pose: &Gaussian<Pose2<f64>>,
        params: &AppearanceMapParams,
    ) {
        let radius = self.match_radius(params);
        for id in missed {
            let Some(reference) = self.reference(id) else { continue };
            let mut reference = reference.clone();
            for place in &mut reference.places {
                place.weight = weight_when_missed(place, pose, radius, (self.scale(), params));
            }
            changed.insert(id, reference);
        }
    }

    /// Writes the changes. Removes light places, and references without places.
    fn commit(&mut self, changed: BTreeMap<ReferenceId, ReferenceView>, least: f64) -> Vec<ReferenceId> {
        let mut forgotten = Vec::new();
        for (id, mut reference) in changed {
            reference.places.retain(|place| place.weight >= least);
            if reference.places.is_empty() {
                self.remove(id);
                forgotten.push(id);
            } else {
                self.replace(id, reference);
            }
        }
        forgotten
    }

    /// Bounds the size: removes the least important references, the oldest among equals, but not the newest.
    fn shrink(&mut self, most: usize, newest: Option<ReferenceId>) -> Vec<ReferenceId> {
        let mut removed = Vec::new();
        while self.len() > most {
            let candidates = self.references().iter().filter(|(id, _)| Some(**id) != newest);
            let least = candidates.min_by(|(_, a), (_, b)| a.importance().total_cmp(&b.importance()));
            let Some(id) = least.map(|(id, _)| *id) else { break };
            self.remove(id);
            removed.push(id);
        }
        removed
    }
}

/// A new place has weight 0 and then matches at distance 0: Eq. 16 gives the learning rate.
fn first_seen(pose: &Gaussian<Pose2<f64>>, params: &AppearanceMapParams) -> ReferenceView {
    let weight = params.weight_learning_rate.max(params.min_weight);
    ReferenceView { places: vec![PlaceComponent { weight, count: 1.0, gaussian: pose.clone() }] }
}
