use wayfix_estimation_traits::Pose2;
use wayfix_gaussian_core::Gaussian;

use super::belief::{Belief, Outlook};
use super::{AppearanceLocalizer, LocalizerParams, Observation};
use crate::{
    AppearanceMapError, AppearanceMapParams, Descriptor, FusionParams, PlaceMatch, PoseHypothesis,
    PoseSource, ReferenceSearch, fuse, interpolate, separation_squared, simplify, superpose,
};

/// Similarity of a view to a reference of the place where the robot is thought to be, from which on nothing else is looked for.
const SURE_SIMILARITY: f64 = 0.3;

/// Share of a step between views from which on a view is another one.
const LEAST_NEWS: f64 = 0.25;

impl<D: Descriptor + Clone, S: ReferenceSearch<D>> AppearanceLocalizer<D, S> {
    /// Whether the robot has moved since the last view that was used: one from the same spot tells nothing new, and would only make the
    /// state believe itself.
    pub(super) fn is_news(&self) -> bool {
        let way = self.motion.increment.translation.norm();
        !self.has_seen || self.belief.state.is_none() || way >= LEAST_NEWS * self.map.scale().step()
    }

    /// A belief after a view, if there is one, and other sources; and how many places of the map look like the view.
    pub(super) fn seen(
        &self,
        belief: &Belief,
        view: Option<&D>,
        sources: &[&dyn PoseSource],
    ) -> Result<(Belief, usize), AppearanceMapError> {
        let (mut observed, n_sightings) = match view {
            Some(view) => self.observe(belief, view)?,
            None => (Vec::new(), 0),
        };
        let weighting = belief.anywhere.weighting(self.params.fusion.mixture_weighting);
        let fusion = FusionParams { mixture_weighting: weighting, ..self.params.fusion };
        let mut predicted = belief.state.as_ref().map(PoseHypothesis::of_mixture).unwrap_or_default();
        if belief.outlook == Outlook::Nearby {
            observed = self.expected(observed, &predicted)?;
        }
        if let Some(view) = view {
            self.steady(view, &mut predicted, &observed)?;
        }
        let mut fused = fuse(&predicted, &observed, &fusion)?;
        for source in sources {
            fused = fuse(&fused, &source.hypotheses(belief.state.as_ref())?, &fusion)?;
        }
        let anywhere = if view.is_some() {
            belief.anywhere.after(fusion.mixture_weighting, &fused)
        } else {
            belief.anywhere
        };
        let state = if fused.is_empty() {
            None
        } else {
            Some(PoseHypothesis::into_mixture(simplify(fused, &self.params.simplify)?)?)
        };
        Ok((Belief { state, anywhere, outlook: belief.outlook }, n_sightings))
    }

    /// $`p(x_t | y_t)`$, and of how many places it is made.
    fn observe(&self, belief: &Belief, view: &D) -> Result<(Vec<PoseHypothesis>, usize), AppearanceMapError> {
        let params = &self.params;
        match params.observation {
            Observation::Superposition => {
                let sightings = self.map.all_place_matches(view, &params.map);
                Ok((superpose(&sightings), sightings.len()))
            }
            Observation::Interpolation => {
                let limit = self.match_limit(belief);
                let components = belief.components();
                let mut sightings =
                    self.apart_from_trail(self.map.place_matches_near(view, components, limit));
                if belief.outlook != Outlook::Nearby && !self.is_supported_by(belief, &sightings) {
                    let found = self.map.place_matches_anywhere(view, components, params.most_matches, limit);
                    sightings = self.apart_from_trail(found);
                }
                Ok((interpolate(&sightings, components, self.map.scale())?, sightings.len()))
            }
        }
    }

    /// What of the observed agrees with something predicted.
    fn expected(
        &self,
        observed: Vec<PoseHypothesis>,
        predicted: &[PoseHypothesis],
    ) -> Result<Vec<PoseHypothesis>, AppearanceMapError> {
        let agrees = |seen: &PoseHypothesis| self.agrees(&seen.gaussian, predicted);
        let agreeing = observed.into_iter().map(|seen| Ok(agrees(&seen)?.then_some(seen)));
        agreeing.filter_map(Result::transpose).collect()
    }

    /// Whether something observed means the same place.
    pub(super) fn agrees(
        &self,
        belief: &Gaussian<Pose2<f64>>,
        observed: &[PoseHypothesis],
    ) -> Result<bool, AppearanceMapError> {
        for hypothesis in observed {
            if separation_squared(belief, &hypothesis.gaussian)? < self.params.fusion.gate {
                return Ok(true);
            }
        }
        Ok(false)
    }

    /// $`E^{max}`$, which is greater for who is lost.
    fn match_limit(&self, belief: &Belief) -> f64 {
        let LocalizerParams { map, relocation, .. } = self.params;
        let is_lost = belief.outlook == Outlook::Lost && !belief.anywhere.is_little();
        let share = if is_lost {
            map.match_limit_fraction.max(relocation.match_share)
        } else {
            map.match_limit_fraction
        };
        self.map.match_limit(&AppearanceMapParams { match_limit_fraction: share, ..map })
    }

    pub(super) fn apart_from_trail(&self, mut sightings: Vec<PlaceMatch>) -> Vec<PlaceMatch> {
        sightings.retain(|s| !self.trail.holds(s.matched.id));
        sightings
    }

    /// Whether the robot is where it thinks it is beyond doubt, and there is no need to look for it in the whole map.
    fn is_supported_by(&self, belief: &Belief, sightings: &[PlaceMatch]) -> bool {
        belief.one_place(&self.params.unimodal).is_some()
            && sightings.iter().any(|s| s.similarity > SURE_SIMILARITY)
    }
}
