use nalgebra::{Matrix3, Vector3};
use wayfix_estimation_traits::Pose2;
use wayfix_gaussian_core::Gaussian;

use super::belief::Belief;
use super::{AppearanceLocalizer, LocalizerParams, PoseHypothesisRule};
use crate::model::{GROUP_SIZE, N_FAR};
use crate::{
    AppearanceMap, AppearanceMapError, GaussianMixtureLikelihood, PoseHypothesis, ReferenceSearch,
    ViewDescriptor, interpolate, superpose,
};

/// Likelihood of a view that does not match, relative to the peak of one that does: the probability that the best of the references of a wrong
/// place is nearer to the view than those of far places.
const FLOOR: f64 = GROUP_SIZE as f64 / (GROUP_SIZE + N_FAR) as f64;

/// $`p(y_t|x_t)`$, and the number of matching places.
pub(super) struct ViewMatch {
    pub(super) likelihood: GaussianMixtureLikelihood,
    pub(super) n_detections: usize,
}

impl ViewMatch {
    /// The highest peak; the first of equal ones.
    pub(super) fn best(&self) -> Option<&Gaussian<Pose2<f64>>> {
        let higher = |best: &&PoseHypothesis, next: &&PoseHypothesis| best.weight.total_cmp(&next.weight);
        self.likelihood.peaks.iter().rev().max_by(higher).map(|peak| &peak.gaussian)
    }
}

impl<D: ViewDescriptor + Clone, S: ReferenceSearch<D>, M> AppearanceLocalizer<D, S, M> {
    /// The likelihood of a view. After a turn without translation, the view has no new information about the position, but compares other sectors
    /// for its heading: the position of the peaks becomes uncertain, and the rest independent, as the distance is short against half a step.
    pub(super) fn match_view(&self, view: &D) -> Result<ViewMatch, AppearanceMapError> {
        let mut matched = self.map.match_view(view, &self.belief, &self.params)?;
        let moved = (2.0 * self.motion.distance() / self.map.scale().step()).max(f64::EPSILON.sqrt());
        if self.has_seen && moved < 1.0 {
            let wider = Matrix3::from_diagonal(&Vector3::new(1.0 / moved, 1.0 / moved, 1.0));
            for PoseHypothesis { gaussian, independent, .. } in &mut matched.likelihood.peaks {
                let covariance = wider * gaussian.covariance() * wider;
                *gaussian = Gaussian::from_parts_unchecked(*gaussian.mean(), covariance);
                *independent = 1.0 - moved * (1.0 - *independent);
            }
        }
        Ok(matched)
    }
}

impl<D: ViewDescriptor, S: ReferenceSearch<D>> AppearanceMap<D, S> {
    /// The places that match the view. [Gross et al. 2005, Sec. 2.2, Eqs. 9–10]
    ///
    /// The search covers the references around the belief. It covers the whole map if the pose is unknown, or if the belief reaches far places.
    pub(super) fn match_view(
        &self,
        view: &D,
        belief: &Belief,
        params: &LocalizerParams,
    ) -> Result<ViewMatch, AppearanceMapError> {
        let (matches, peaks) = match params.pose_hypothesis_rule {
            PoseHypothesisRule::Superposition => {
                let matches = self.all_place_matches(view, &params.map);
                let peaks = superpose(&matches);
                (matches, peaks)
            }
            PoseHypothesisRule::Interpolation => {
                let components = belief.components();
                let reaches_far = components.iter().any(|component| {
                    self.search_radius(component, &params.map, params.fusion.gate)
                        > self.scale().far_distance()
                });
                let is_wide = reaches_far || belief.uniform > 1.0 - params.unimodal_min_weight;
                let n_anywhere = if is_wide { params.mixture_reduction.max_components } else { 0 };
                let matches =
                    self.place_matches(view, components, n_anywhere, (&params.map, params.fusion.gate));
                let peaks = interpolate(&matches, components, self.scale())?;
                (matches, peaks)
            }
        };
        Ok(ViewMatch {
            likelihood: GaussianMixtureLikelihood { peaks, floor: FLOOR },
            n_detections: matches.len(),
        })
    }
}
