use wayfix_estimation_traits::{MotionModel, Pose2};
use wayfix_gaussian_core::{Gaussian, GaussianMixture};

use super::{LocalizerParams, StartPosePrior};
use crate::state::Motion;
use crate::{
    AppearanceMapError, GaussianMixtureLikelihood, MixtureWeighting, PoseHypothesis, PoseHypothesisSource,
    UniformComponent, fuse, propagate, simplify, unimodal,
};

/// $`p(x_t)`$: a Gaussian mixture and a uniform component.
#[derive(Clone, Debug)]
pub(super) struct Belief {
    /// The heaviest component first; `None` if the pose is unknown.
    pub(super) state: Option<GaussianMixture<Pose2<f64>>>,
    /// Probability of the uniform component: the robot may be anywhere.
    pub(super) uniform: f64,
}

impl Belief {
    pub(super) fn of_start(start: StartPosePrior) -> Result<Self, AppearanceMapError> {
        let state = start.into_state()?;
        let uniform = if state.is_some() { 0.0 } else { 1.0 };
        Ok(Self { state, uniform })
    }

    /// A single pose.
    pub(super) fn at(pose: Gaussian<Pose2<f64>>) -> Result<Self, AppearanceMapError> {
        Self::of_start(StartPosePrior::Known(pose))
    }

    pub(super) fn components(&self) -> &[Gaussian<Pose2<f64>>] {
        self.state.as_ref().map_or(&[], GaussianMixture::components)
    }

    pub(super) fn heaviest(&self) -> Option<&Gaussian<Pose2<f64>>> {
        self.components().first()
    }

    /// The pose, if one component has `min_weight` of the whole.
    pub(super) fn unimodal(&self, min_weight: f64) -> Option<&Gaussian<Pose2<f64>>> {
        unimodal(self.state.as_ref()?, min_weight / (1.0 - self.uniform))
    }

    /// After an odometry increment. [Gross et al. 2005, Eq. 1]
    pub(super) fn predicted<M>(&self, increment: &Pose2<f64>, motion: &M) -> Result<Self, AppearanceMapError>
    where
        M: MotionModel<State = Pose2<f64>, Control = Pose2<f64>>,
    {
        self.each_moved(|component| propagate(component, increment, motion))
    }

    /// After a motion with its own covariance.
    pub(super) fn moved(&self, motion: &Motion) -> Result<Self, AppearanceMapError> {
        let refused = AppearanceMapError::NotFinite { what: "covariance of a motion" };
        self.each_moved(|component| motion.applied(component).ok_or(refused.clone()))
    }

    fn each_moved(
        &self,
        moved: impl Fn(&Gaussian<Pose2<f64>>) -> Result<Gaussian<Pose2<f64>>, AppearanceMapError>,
    ) -> Result<Self, AppearanceMapError> {
        let Some(state) = &self.state else { return Ok(self.clone()) };
        let weighted = state.log_weights().iter().zip(state.components());
        let moved = weighted.map(|(log_weight, component)| Ok((*log_weight, moved(component)?)));
        let moved = moved.collect::<Result<Vec<_>, AppearanceMapError>>()?;
        Ok(Self { state: Some(GaussianMixture::from_log_weights(moved)?), ..*self })
    }

    /// Fused with the view and all other sources, simplified, and normalized at the end. [Gross et al. 2005, Eqs. 2–8]
    ///
    /// With weights by evidence and relocalization, the uniform component has at least the prior probability of a kidnapping, so that a source can
    /// contradict the prediction.
    pub(super) fn fused(
        &self,
        view: Option<&GaussianMixtureLikelihood>,
        sources: &[&dyn PoseHypothesisSource],
        area: f64,
        params: &LocalizerParams,
    ) -> Result<Self, AppearanceMapError> {
        let is_evidence = params.fusion.mixture_weighting == MixtureWeighting::Evidence;
        let can_be_moved = is_evidence && !params.relocalization.is_off();
        let prior = if can_be_moved { params.relocalization.probability(1.0) } else { 0.0 };
        let mut uniform =
            UniformComponent { weight: self.uniform.max(prior), volume: area * std::f64::consts::TAU };
        let mut fused = self.state.as_ref().map(PoseHypothesis::of_mixture).unwrap_or_default();
        for hypothesis in &mut fused {
            hypothesis.weight *= 1.0 - uniform.weight;
        }
        if let Some(likelihood) = view {
            (fused, uniform) = fuse(&fused, uniform, likelihood, &params.fusion)?;
        }
        for source in sources {
            let hypotheses = source.hypotheses(self.state.as_ref())?;
            let likelihood = if is_evidence {
                GaussianMixtureLikelihood::of_probabilities(hypotheses, &uniform)
            } else {
                GaussianMixtureLikelihood { peaks: hypotheses, floor: 0.0 }
            };
            (fused, uniform) = fuse(&fused, uniform, &likelihood, &params.fusion)?;
        }
        if fused.iter().all(|hypothesis| hypothesis.weight == 0.0) {
            return Ok(Self { state: None, uniform: 1.0 });
        }
        let simplified = simplify(fused, &params.mixture_reduction)?;
        let total: f64 = simplified.iter().map(|hypothesis| hypothesis.weight).sum();
        let state = Some(PoseHypothesis::into_mixture(simplified)?);
        Ok(Self { state, uniform: uniform.weight / (uniform.weight + total) })
    }
}
