use wayfix_estimation_traits::{Pose2, wrap_angle};
use wayfix_gaussian_core::Gaussian;

use super::fit::{GATE_SIGMAS, HERE_TURN};
use super::{AppearanceLocalizer, Observation};
use crate::{
    AppearanceMapError, Descriptor, HeadingMeasurement, PoseHypothesis, ReferenceSearch, update_heading,
};

/// Weight from which on a hypothesis is worth the comparisons.
const LEAST_WEIGHT: f64 = 0.05;

/// σ of a learned heading up to which references speak, rad: half of what a comparison errs by at best, which a pose has that was surveyed. Whose heading is known
/// worse has it from a robot that built the map on its way, and errs with it.
pub(super) const MOST_LEARNED_SIGMA: f64 = 0.015;

impl<D: Descriptor + Clone, S: ReferenceSearch<D>> AppearanceLocalizer<D, S> {
    /// Tells hypotheses that nothing observed agrees with at least which way they look.
    ///
    /// Who drives beside the taught lane, or past shelves that were rearranged, recognizes nothing for many metres, and goes astray by its heading: 4° are
    /// 1.4 m after 20 m.
    pub(super) fn steady(
        &self,
        view: &D,
        predicted: &mut [PoseHypothesis],
        observed: &[PoseHypothesis],
    ) -> Result<(), AppearanceMapError> {
        if self.params.observation != Observation::Interpolation {
            return Ok(());
        }
        for hypothesis in predicted.iter_mut().filter(|hypothesis| hypothesis.weight >= LEAST_WEIGHT) {
            if self.agrees(&hypothesis.gaussian, observed)? {
                continue;
            }
            if let Some(facing) = self.facing(view, &hypothesis.gaussian)? {
                hypothesis.gaussian = update_heading(&hypothesis.gaussian, &facing)?;
            }
        }
        Ok(())
    }

    /// Which way the robot looks by the references around a belief, those that look more like the view than all of some far places do.
    fn facing(
        &self,
        view: &D,
        belief: &Gaussian<Pose2<f64>>,
    ) -> Result<Option<HeadingMeasurement>, AppearanceMapError> {
        let Some(limit) = self.map.least_distance_to_far(view, belief.mean(), self.views) else {
            return Ok(None);
        };
        let most = HERE_TURN + GATE_SIGMAS * belief.sigmas().z;
        let mut around =
            self.apart_from_trail(self.map.place_matches_near(view, std::slice::from_ref(belief), limit));
        around.retain(|s| wrap_angle(s.gaussian.mean().heading() - belief.mean().heading()).abs() <= most);
        let facing = HeadingMeasurement::of(&around, self.map.scale())?;
        Ok(facing.filter(|facing| facing.map_variance <= MOST_LEARNED_SIGMA * MOST_LEARNED_SIGMA))
    }
}
