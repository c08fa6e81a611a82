use nalgebra::Matrix3;
use wayfix_estimation_traits::{LieGroup, MotionModel, Pose2};
use wayfix_gaussian_core::{Gaussian, GaussianMixture};

use super::belief::Belief;
use super::pose_history::PoseHistory;
use super::relocalize::KidnapTest;
use super::{LocalizerEvent, LocalizerParams, MapLearning, StartPosePrior, ViewUpdateOutcome};
use crate::model::{HEADING_SIGMA, ScaleLearner};
use crate::state::Motion;
use crate::{
    AppearanceMap, AppearanceMapError, LinearSearch, OdometryNoise, PoseHypothesisSource, ReferenceId,
    ReferenceSearch, ViewDescriptor, separation_squared,
};

/// Localizes in an appearance map, and learns it. [Gross et al. 2005, Fig. 1]
///
/// [`predict`](Self::predict) with each odometry increment, [`update`](Self::update) with each view. With an empty map and a known start the
/// robot builds the map; [`teach`](Self::teach) builds one from known poses. `D` is the view, `S` the search among views, and `M` the motion
/// model.
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
/// use wayfix_appearance_cml::{AppearanceLocalizer, LocalizerParams, StartPosePrior};
/// use wayfix_estimation_traits::Pose2;
/// use wayfix_gaussian_core::Gaussian;
/// let start = Gaussian::from_sigmas(Pose2::new(0.0, 0.0, 0.0), &Vector3::new(0.01, 0.01, 0.01))?;
/// let mut localizer: AppearanceLocalizer<Brightness> =
///     AppearanceLocalizer::new(LocalizerParams::default(), StartPosePrior::Known(start))?;
/// for step in 0..40 {
///     localizer.update(Brightness(0.1 * f64::from(step)))?;
///     localizer.predict(&Pose2::new(0.25, 0.0, 0.0))?;
/// }
/// assert!(localizer.map().len() > 10);
/// assert!(localizer.predict(&Pose2::new(f64::NAN, 0.0, 0.0)).is_err());
/// assert!((localizer.estimate().map_or(0.0, |pose| pose.mean().x()) - 10.0).abs() < 0.1);
/// # Ok::<(), wayfix_appearance_cml::AppearanceMapError>(())
/// ```
#[derive(Clone, Debug)]
pub struct AppearanceLocalizer<D, S = LinearSearch<D>, M = OdometryNoise> {
    pub(super) params: LocalizerParams,
    pub(super) motion_model: M,
    pub(super) map: AppearanceMap<D, S>,
    pub(super) belief: Belief,
    pub(super) kidnap: KidnapTest,
    /// Since the last view that was used.
    pub(super) motion: Motion,
    pub(super) history: PoseHistory<D>,
    pub(super) scale_learner: ScaleLearner<D>,
    /// The last view that left the history.
    pub(super) learned_last: Option<D>,
    taught_last: Option<Pose2<f64>>,
    was_unimodal: bool,
    pub(super) has_seen: bool,
    /// Number of views, which chooses other far references for each.
    pub(super) n_views: u32,
}

impl<D: ViewDescriptor + Clone, S: ReferenceSearch<D> + Default> AppearanceLocalizer<D, S> {
    /// A localizer with an empty map.
    ///
    /// # Errors
    /// Returns an error if a parameter is out of range or the start is invalid.
    pub fn new(params: LocalizerParams, start: StartPosePrior) -> Result<Self, AppearanceMapError> {
        Self::with_map(params, AppearanceMap::default(), start)
    }
}

impl<D: ViewDescriptor + Clone, S: ReferenceSearch<D>> AppearanceLocalizer<D, S> {
    /// A localizer with a map, and with the motion model [`LocalizerParams::odometry`].
    ///
    /// # Errors
    /// Returns an error if a parameter is out of range or the start is invalid.
    pub fn with_map(
        params: LocalizerParams,
        map: AppearanceMap<D, S>,
        start: StartPosePrior,
    ) -> Result<Self, AppearanceMapError> {
        Self::with_motion_model(params, map, start, params.odometry)
    }
}

impl<D: ViewDescriptor + Clone, S: ReferenceSearch<D>, M> AppearanceLocalizer<D, S, M>
where
    M: MotionModel<State = Pose2<f64>, Control = Pose2<f64>>,
{
    /// A localizer with a map and a motion model; [`LocalizerParams::odometry`] is not used.
    ///
    /// # Errors
    /// Returns an error if a parameter is out of range or the start is invalid.
    pub fn with_motion_model(
        params: LocalizerParams,
        map: AppearanceMap<D, S>,
        start: StartPosePrior,
        motion_model: M,
    ) -> Result<Self, AppearanceMapError> {
        params.validate()?;
        let belief = Belief::of_start(start)?;
        Ok(Self {
            motion_model,
            map,
            was_unimodal: belief.state.is_some(),
            belief,
            kidnap: KidnapTest::new(&params)?,
            motion: Motion::none(),
            history: PoseHistory::default(),
            scale_learner: ScaleLearner::default(),
            learned_last: None,
            taught_last: None,
            has_seen: false,
            n_views: 0,
            params,
        })
    }

    /// The parameters.
    pub fn params(&self) -> &LocalizerParams {
        &self.params
    }
    /// The map.
    pub fn map(&self) -> &AppearanceMap<D, S> {
        &self.map
    }
    /// The map without the views that wait to be learned.
    pub fn into_map(self) -> AppearanceMap<D, S> {
        self.map
    }
    /// The belief; `None` if the pose is unknown.
    pub fn state(&self) -> Option<&GaussianMixture<Pose2<f64>>> {
        self.belief.state.as_ref()
    }
    /// The heaviest component.
    pub fn estimate(&self) -> Option<&Gaussian<Pose2<f64>>> {
        self.belief.heaviest()
    }

    /// Starts at another pose. Views that wait to be learned are given up.
    ///
    /// # Errors
    /// Returns an error if the start is invalid.
    pub fn restart(&mut self, start: StartPosePrior) -> Result<(), AppearanceMapError> {
        let (belief, kidnap) = (Belief::of_start(start)?, KidnapTest::new(&self.params)?);
        self.was_unimodal = belief.state.is_some();
        (self.belief, self.kidnap, self.motion) = (belief, kidnap, Motion::none());
        self.history = PoseHistory::default();
        self.scale_learner.interrupt();
        (self.learned_last, self.has_seen) = (None, false);
        Ok(())
    }

    /// Predicts the belief by an odometry increment, in the body frame at its beginning. [Gross et al. 2005, Eq. 1]
    ///
    /// # Errors
    /// Returns an error if the increment is not finite; the state is then unchanged.
    pub fn predict(&mut self, increment: &Pose2<f64>) -> Result<(), AppearanceMapError> {
        let from = self.belief.heaviest().map_or(self.motion.increment, |pose| *pose.mean());
        let motion = self.motion.then(&Motion::of_increment(&self.motion_model, &from, increment))?;
        self.belief = self.belief.predicted(increment, &self.motion_model)?;
        self.motion = motion;
        self.kidnap.predict(|belief| belief.predicted(increment, &self.motion_model));
        Ok(())
    }

    /// Predicts the belief by a motion that nothing measured, with this covariance in the body frame, m² and rad².
    ///
    /// # Errors
    /// Returns an error if the covariance is not finite or has a negative eigenvalue; the state is then unchanged.
    pub fn predict_unknown(&mut self, covariance: &Matrix3<f64>) -> Result<(), AppearanceMapError> {
        let unknown = Motion { increment: Pose2::identity(), covariance: *covariance, has_gap: true };
        let motion = self.motion.then(&unknown)?;
        let (least, rounding) =
            (covariance.symmetric_eigenvalues().min(), 16.0 * f64::EPSILON * covariance.trace());
        let what = "eigenvalue of the covariance of an unknown motion";
        crate::check::within(what, least, least >= -rounding, "not negative")?;
        self.belief = self.belief.moved(&unknown)?;
        self.motion = motion;
        self.kidnap.predict(|belief| belief.moved(&unknown));
        Ok(())
    }

    /// Updates belief and map with a view.
    ///
    /// # Errors
    /// Returns an error if the belief is singular or a number is not finite; state and map are then unchanged. Returns
    /// [`AppearanceMapError::ReferenceIdsExhausted`] if a new reference finds no number; the map is then unchanged, and the state is updated.
    pub fn update(&mut self, view: D) -> Result<ViewUpdateOutcome, AppearanceMapError> {
        self.update_with(view, &[])
    }

    /// Updates belief and map with a view and other sources. [Gross et al. 2005, Sec. 2]
    ///
    /// # Errors
    /// Returns the errors of [`update`](Self::update), and the error of a source.
    pub fn update_with(
        &mut self,
        view: D,
        sources: &[&dyn PoseHypothesisSource],
    ) -> Result<ViewUpdateOutcome, AppearanceMapError> {
        let view = self.is_news().then_some(view);
        let matched = view.as_ref().map(|view| self.match_view(view)).transpose()?; // Eqs. 9-10
        let likelihood = matched.as_ref().map(|matched| &matched.likelihood);
        let mut belief = self.belief.fused(likelihood, sources, self.map.area(), &self.params)?; // Eqs. 2-8
        let mut kidnap = self.kidnap.clone();
        let is_moved = match &view {
            Some(view) => self.relocalize(view, &mut kidnap, &mut belief)?,
            None => false,
        };
        let mut events = self.replace_belief(belief, kidnap, is_moved)?;
        if let Some(view) = view {
            self.has_seen = true;
            self.n_views = self.n_views.wrapping_add(1);
            let motion = std::mem::replace(&mut self.motion, Motion::none());
            if self.params.map_learning == MapLearning::Adapting {
                self.learn(view, &motion, &mut events)?; // Eqs. 11-19
            }
        }
        Ok(ViewUpdateOutcome {
            events,
            estimate: self.one_place().cloned(),
            n_detections: matched.as_ref().map_or(0, |matched| matched.n_detections),
            best_match: matched.as_ref().and_then(|matched| matched.best()).cloned(),
        })
    }

    /// Learns that `view` is seen from the known `pose`. The belief stays.
    ///
    /// # Errors
    /// Returns an error if the pose is invalid or no reference number is left; the map is then unchanged.
    pub fn teach(&mut self, view: D, pose: &Gaussian<Pose2<f64>>) -> Result<ReferenceId, AppearanceMapError> {
        let distance =
            self.taught_last.map_or(0.0, |last| (pose.mean().translation - last.translation).norm());
        let id = self.map.teach(view.clone(), pose)?;
        self.taught_last = Some(*pose.mean());
        self.n_views = self.n_views.wrapping_add(1);
        self.measure(distance, &view, Some(pose.mean()));
        Ok(id)
    }

    /// Whether the robot has moved since the last view that was used: by half a step, or, where the belief is unimodal, by an angle that a
    /// comparison resolves. A view from the same pose carries no new information. A measured motion below its own σ is no motion.
    fn is_news(&self) -> bool {
        let Motion { increment, covariance, has_gap } = &self.motion;
        let distance = self.motion.distance();
        let sigma = covariance.fixed_view::<2, 2>(0, 0).trace().sqrt();
        let has_moved = distance >= self.map.scale().step() / 2.0 && distance > sigma;
        let has_turned = increment.heading().abs() > HEADING_SIGMA && self.one_place().is_some();
        !self.has_seen || *has_gap || has_moved || has_turned
    }

    /// The pose, if the belief is unimodal and no alternative is likely.
    pub(super) fn one_place(&self) -> Option<&Gaussian<Pose2<f64>>> {
        let min_weight = self.params.unimodal_min_weight;
        self.belief.unimodal(min_weight).filter(|_| self.kidnap.probability() <= 1.0 - min_weight)
    }

    /// Replaces the belief and its test; `is_moved` is true if an alternative is accepted.
    pub(super) fn replace_belief(
        &mut self,
        belief: Belief,
        kidnap: KidnapTest,
        is_moved: bool,
    ) -> Result<Vec<LocalizerEvent>, AppearanceMapError> {
        let is_elsewhere = match (belief.heaviest(), self.belief.heaviest()) {
            (Some(new), Some(old)) => separation_squared(new, old)? > self.params.fusion.gate,
            _ => false,
        };
        (self.belief, self.kidnap) = (belief, kidnap);
        let is_unimodal = self.one_place().is_some();
        let mut events = Vec::new();
        match (std::mem::replace(&mut self.was_unimodal, is_unimodal), is_unimodal) {
            (true, false) => events.push(LocalizerEvent::Lost),
            (false, true) => events.push(LocalizerEvent::Found),
            _ => {}
        }
        events.extend((is_moved || is_elsewhere).then_some(LocalizerEvent::Relocated));
        Ok(events)
    }
}
