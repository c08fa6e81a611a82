use super::belief::Belief;
use super::{AppearanceLocalizer, LocalizerParams, Observation};
use crate::model::{GROUP_SIZE, N_FAR};
use crate::{
    AppearanceError, AppearanceMap, Descriptor, PoseLikelihood, ReferenceSearch, interpolate, superpose,
};

/// Likelihood of a view that does not match, relative to the peak of one that does: the probability that the best of the references of a wrong
/// place is nearer to the view than those of far places.
const FLOOR: f64 = GROUP_SIZE as f64 / (GROUP_SIZE + N_FAR) as f64;

/// $`p(y_t|x_t)`$, and the number of matching places.
pub(super) struct ViewMatch {
    pub(super) likelihood: PoseLikelihood,
    pub(super) n_detections: usize,
}

impl<D: Descriptor + Clone, S: ReferenceSearch<D>, M> AppearanceLocalizer<D, S, M> {
    /// The likelihood of a view, which is independent of the previous one only if the robot has moved.
    pub(super) fn match_view(&self, view: &D) -> Result<ViewMatch, AppearanceError> {
        let mut matched = self.map.match_view(view, &self.belief, &self.params)?;
        let half_step = self.map.scale().step() / 2.0;
        if self.has_seen && self.motion.distance() < half_step {
            for peak in &mut matched.likelihood.peaks {
                peak.independent *= self.motion.distance() / half_step;
            }
        }
        Ok(matched)
    }
}

impl<D: Descriptor, S: ReferenceSearch<D>> AppearanceMap<D, S> {
    /// The places that match the view. [Gross et al. 2005, Sec. 2.2, Eqs. 9-10]
    ///
    /// The search covers the references around the belief. It covers the whole map if the pose is unknown, or if the belief reaches far places.
    pub(super) fn match_view(
        &self,
        view: &D,
        belief: &Belief,
        params: &LocalizerParams,
    ) -> Result<ViewMatch, AppearanceError> {
        let (matches, peaks) = match params.observation {
            Observation::Superposition => {
                let matches = self.all_place_matches(view, &params.map);
                let peaks = superpose(&matches);
                (matches, peaks)
            }
            Observation::Interpolation => {
                let components = belief.components();
                let reaches_far = components.iter().any(|component| {
                    self.search_radius(component, &params.map, params.fusion.gate)
                        > self.scale().far_distance()
                });
                let is_wide = reaches_far || belief.uniform > 1.0 - params.unimodal_weight;
                let n_anywhere = if is_wide { params.simplify.max_components } else { 0 };
                let matches =
                    self.place_matches(view, components, n_anywhere, (&params.map, params.fusion.gate));
                let peaks = interpolate(&matches, components, self.scale())?;
                (matches, peaks)
            }
        };
        Ok(ViewMatch { likelihood: PoseLikelihood { peaks, floor: FLOOR }, n_detections: matches.len() })
    }
}
