use wayfix_estimation_traits::{Pose2, wrap_angle};
use wayfix_gaussian_core::{Gaussian, Mixture};

use super::doubt::Fit;
use super::{AppearanceLocalizer, Observation};
use crate::{
    AppearanceError, Descriptor, PoseHypothesis, Recognition, ReferenceSearch, Sighting, SimplifyParams,
    Weighting, interpolate, similarity, superpose, unimodal,
};

/// What a view says.
pub(super) struct Observed {
    pub(super) hypotheses: Vec<PoseHypothesis>,
    /// Of how many places they are made.
    pub(super) n_sightings: usize,
    /// How it fits what was thought before.
    pub(super) fit: Fit,
}

impl Observed {
    pub(super) fn nothing() -> Self {
        Self { hypotheses: Vec::new(), n_sightings: 0, fit: Fit::Unknown }
    }
}

/// References that look like one view: those a group of neighbours is made of, along a lane driven once.
const REFERENCES_OF_A_PLACE: f64 = 12.0;
/// A heading that differs by more, and by more than the belief is in doubt, is not the same, rad.
const HERE_TURN: f64 = 0.6;
/// σ of a belief within which it may be.
const GATE_SIGMAS: f64 = 3.0;

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

    /// What weights are made of, with this much doubt.
    pub(super) fn weighting(&self) -> Weighting {
        match self.params.fusion.weighting {
            Weighting::Evidence { .. } if self.doubt.is_great() => {
                let n_places = self.map.len() as f64 / REFERENCES_OF_A_PLACE;
                self.params.relocation.weighting(self.anywhere.weight(), n_places)
            }
            weighting => self.anywhere.weighting(weighting),
        }
    }

    /// How small the mixture is kept, with this much doubt.
    pub(super) fn simplification(&self) -> SimplifyParams {
        let usual = &self.params.simplify;
        if self.doubt.is_great() { self.params.relocation.simplification(usual) } else { *usual }
    }

    /// $`p(x_t | y_t)`$.
    pub(super) fn observe(&self, view: &D) -> Result<Observed, AppearanceError> {
        let params = &self.params;
        match params.observation {
            Observation::Superposition => {
                let sightings = self.map.all_sightings(view, &params.map);
                let (hypotheses, n_sightings) = (superpose(&sightings), sightings.len());
                Ok(Observed { hypotheses, n_sightings, ..Observed::nothing() })
            }
            Observation::Interpolation => {
                let belief = self.state.as_ref().map_or(&[][..], Mixture::components);
                let apart_from_trail = |mut sightings: Vec<Sighting>| {
                    sightings.retain(|s| !self.trail.holds(s.matched.id));
                    sightings
                };
                let in_doubt = self.doubt.is_great();
                let how = (&params.map, if in_doubt { Recognition::Weak } else { Recognition::Sure });
                let mut sightings = apart_from_trail(self.map.sightings_near(view, belief, how));
                let fit = self.fit(view, &sightings);
                if in_doubt || !self.is_supported_by(&sightings) {
                    let most = params.most_matches;
                    sightings = apart_from_trail(self.map.sightings_anywhere(view, belief, most, how));
                }
                let hypotheses = interpolate(&sightings, belief, self.map.scale())?;
                Ok(Observed { hypotheses, n_sightings: sightings.len(), fit })
            }
        }
    }

    /// How the view fits the heaviest hypothesis; `near` is what looks like it there and at all others.
    fn fit(&self, view: &D, near: &[Sighting]) -> Fit {
        let Some(heaviest) = self.estimate().filter(|_| self.params.relocation.doubt < 1.0) else {
            return Fit::Unknown;
        };
        let (at, sigmas) = (heaviest.mean(), heaviest.sigmas());
        let reach = self.map.reach_of_match(&self.params.map);
        let is_here = |place: &Pose2<f64>| {
            (place.translation - at.translation).norm() <= reach + GATE_SIGMAS * sigmas.xy().norm()
                && wrap_angle(place.heading() - at.heading()).abs() <= HERE_TURN + GATE_SIGMAS * sigmas.z
        };
        let limit = self.map.match_limit(&self.params.map);
        let sure = |s: &Sighting| similarity(s.matched.comparison.distance, limit) > SURE_SIMILARITY;
        let here: Vec<&Sighting> = near.iter().filter(|s| is_here(s.gaussian.mean())).collect();
        if here.iter().any(|s| sure(s)) {
            Fit::Sure
        } else if !here.is_empty() {
            Fit::Recognized
        } else if !self.map.is_well_known(heaviest, reach, |id| !self.trail.holds(id)) {
            Fit::Unknown
        } else {
            let how = (&self.params.map, Recognition::Weak);
            let weak = self.map.sightings_near(view, std::slice::from_ref(heaviest), how);
            let is_weak = |s: &Sighting| !self.trail.holds(s.matched.id) && is_here(s.gaussian.mean());
            if weak.iter().any(is_weak) { Fit::Recognized } else { Fit::Missed }
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
