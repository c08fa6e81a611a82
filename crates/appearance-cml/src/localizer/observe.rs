use wayfix_estimation_traits::Pose2;
use wayfix_gaussian_core::{Gaussian, Mixture};

use super::{AppearanceLocalizer, Observation};
use crate::{
    AppearanceError, Descriptor, PoseHypothesis, ReferenceSearch, Sighting, interpolate, superpose, unimodal,
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
        !self.has_seen || self.state.is_none() || way >= LEAST_NEWS * self.map.scale().step()
    }

    /// $`p(x_t | y_t)`$, and how many places it is made of.
    pub(super) fn observe(&self, view: &D) -> Result<(Vec<PoseHypothesis>, usize), AppearanceError> {
        let params = &self.params;
        match params.observation {
            Observation::Superposition => {
                let sightings = self.map.all_sightings(view, &params.map);
                Ok((superpose(&sightings), sightings.len()))
            }
            Observation::Interpolation => {
                let belief = self.state.as_ref().map_or(&[][..], Mixture::components);
                let apart_from_trail = |mut sightings: Vec<Sighting>| {
                    sightings.retain(|s| !self.trail.holds(s.matched.id));
                    sightings
                };
                let mut sightings = apart_from_trail(self.map.sightings_near(view, belief, &params.map));
                if !self.is_supported_by(&sightings) {
                    let most = params.most_matches;
                    let anywhere = self.map.sightings_anywhere(view, belief, most, &params.map);
                    sightings = apart_from_trail(anywhere);
                }
                Ok((interpolate(&sightings, belief, self.map.scale())?, sightings.len()))
            }
        }
    }

    /// Whether the robot is where it thinks it is beyond doubt, and there is no need to look for it in the whole map.
    fn is_supported_by(&self, sightings: &[Sighting]) -> bool {
        self.one_place().is_some() && sightings.iter().any(|s| s.similarity > SURE_SIMILARITY)
    }

    pub(super) fn one_place(&self) -> Option<&Gaussian<Pose2<f64>>> {
        let state = self.state.as_ref().filter(|_| self.anywhere.is_little());
        state.and_then(|state| unimodal(state, &self.params.unimodal))
    }
}
