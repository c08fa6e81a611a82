use wayfix_estimation_traits::Pose2;
use wayfix_gaussian_core::{Gaussian, Mixture};

use super::anywhere::Anywhere;
use super::doubt::Doubt;
use super::journey::Journey;
use super::observe::Observed;
use super::scale_learner::ScaleLearner;
use super::trail::Trail;
use super::{Event, Learning, LocalizerParams, Motion, Start, UpdateOutcome};
use crate::{
    AppearanceError, AppearanceMap, Descriptor, FusionParams, LinearSearch, PoseHypothesis, PoseSource,
    ReferenceId, ReferenceSearch, fuse, propagate, separation_squared, simplify, unimodal,
};

/// Localizes in an appearance map, and learns it. [Gross et al. 2005]
///
/// [`predict`](Self::predict) with each odometry increment, [`update`](Self::update) with each view. With an empty map and a known start the
/// map is built as the robot goes; [`teach`](Self::teach) builds one from known poses.
///
/// ```
/// # use wayfix_appearance_cml::{Comparison, Descriptor};
/// # #[derive(Clone, Debug)]
/// # struct Brightness(f64);
/// # impl Descriptor for Brightness {
/// #     fn compare(&self, other: &Self) -> Comparison {
/// #         Comparison { distance: (self.0 - other.0).abs(), rotation: 0.0 }
/// #     }
/// # }
/// use nalgebra::Vector3;
/// use wayfix_appearance_cml::{AppearanceLocalizer, LocalizerParams, Start};
/// use wayfix_estimation_traits::Pose2;
/// use wayfix_gaussian_core::Gaussian;
/// let start = Gaussian::from_sigmas(Pose2::new(0.0, 0.0, 0.0), &Vector3::new(0.01, 0.01, 0.01))?;
/// let mut localizer: AppearanceLocalizer<Brightness> =
///     AppearanceLocalizer::new(LocalizerParams::default(), Start::Known(start))?;
/// for step in 0..40 {
///     localizer.update(Brightness(0.1 * f64::from(step)))?;
///     localizer.predict(&Pose2::new(0.25, 0.0, 0.0))?;
/// }
/// assert!(localizer.map().len() > 10);
/// assert!(localizer.predict(&Pose2::new(f64::NAN, 0.0, 0.0)).is_err());
/// assert!((localizer.estimate().map_or(0.0, |pose| pose.mean().x()) - 10.0).abs() < 0.1);
/// # Ok::<(), wayfix_appearance_cml::AppearanceError>(())
/// ```
#[derive(Clone, Debug)]
pub struct AppearanceLocalizer<D, S = LinearSearch<D>> {
    pub(super) params: LocalizerParams,
    pub(super) map: AppearanceMap<D, S>,
    pub(super) state: Option<Mixture<Pose2<f64>>>,
    pub(super) anywhere: Anywhere,
    pub(super) doubt: Doubt,
    /// Since the last view.
    pub(super) motion: Motion,
    pub(super) journey: Journey<D>,
    pub(super) scale_learner: ScaleLearner<D>,
    /// The last view that was learned.
    pub(super) learned_last: Option<D>,
    pub(super) taught_last: Option<Pose2<f64>>,
    pub(super) was_unimodal: bool,
    pub(super) has_seen: bool,
    pub(super) trail: Trail,
    /// How far views have moved the estimate since the way behind was revised, m.
    pub(super) corrected: f64,
    pub(super) since_revision: usize,
    /// Counts views, to pick another far reference with each.
    pub(super) views: u32,
}

impl<D: Descriptor + Clone, S: ReferenceSearch<D> + Default> AppearanceLocalizer<D, S> {
    /// A localizer without a map.
    ///
    /// # Errors
    /// When a parameter or the start has no meaning.
    pub fn new(params: LocalizerParams, start: Start) -> Result<Self, AppearanceError> {
        Self::with_map(params, AppearanceMap::default(), start)
    }
}

impl<D: Descriptor + Clone, S: ReferenceSearch<D>> AppearanceLocalizer<D, S> {
    /// A localizer in a map that was learned before.
    ///
    /// # Errors
    /// When a parameter or the start has no meaning.
    pub fn with_map(
        params: LocalizerParams,
        map: AppearanceMap<D, S>,
        start: Start,
    ) -> Result<Self, AppearanceError> {
        params.validate()?;
        let state = start.into_state()?;
        let was_unimodal = state.is_some();
        let anywhere = if was_unimodal { Anywhere::nothing() } else { Anywhere::everything() };
        Ok(Self {
            params,
            map,
            state,
            anywhere,
            doubt: Doubt::none(),
            motion: Motion::none(),
            journey: Journey::default(),
            scale_learner: ScaleLearner::default(),
            learned_last: None,
            taught_last: None,
            was_unimodal,
            has_seen: false,
            trail: Trail::default(),
            corrected: 0.0,
            since_revision: 0,
            views: 0,
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
    /// The map, when localizing is over; what waits to be learned is not in it.
    pub fn into_map(self) -> AppearanceMap<D, S> {
        self.map
    }
    /// Where the robot may be; `None` when it may be anywhere.
    pub fn state(&self) -> Option<&Mixture<Pose2<f64>>> {
        self.state.as_ref()
    }
    /// The heaviest hypothesis.
    pub fn estimate(&self) -> Option<&Gaussian<Pose2<f64>>> {
        // The heaviest comes first since the mixture is simplified after each view, and odometry changes no weight.
        self.state.as_ref().and_then(|state| state.components().first())
    }

    /// Puts the robot somewhere else; what waits to be learned is given up.
    ///
    /// # Errors
    /// When the start has no meaning.
    pub fn restart(&mut self, start: Start) -> Result<(), AppearanceError> {
        self.state = start.into_state()?;
        self.was_unimodal = self.state.is_some();
        self.anywhere = if self.was_unimodal { Anywhere::nothing() } else { Anywhere::everything() };
        self.doubt = Doubt::none();
        self.motion = Motion::none();
        self.has_seen = false;
        self.journey = Journey::default();
        self.trail = Trail::default();
        self.scale_learner.interrupt();
        self.learned_last = None;
        Ok(())
    }

    /// The robot has moved by `increment`, in the body frame at its beginning.
    ///
    /// # Errors
    /// When the increment is not finite; the state is as before.
    pub fn predict(&mut self, increment: &Pose2<f64>) -> Result<(), AppearanceError> {
        let motion = self.motion.then(increment, &self.params.odometry)?;
        if let Some(state) = &self.state {
            let moved = state.log_weights().iter().zip(state.components()).map(|(log_weight, component)| {
                propagate(component, increment, &self.params.odometry).map(|moved| (*log_weight, moved))
            });
            let moved: Result<Vec<_>, AppearanceError> = moved.collect();
            self.state = Some(Mixture::from_log_weights(moved?)?);
        }
        self.motion = motion;
        Ok(())
    }

    /// The robot sees `view`.
    ///
    /// # Errors
    /// When a belief has become singular or something is not finite; state and map are as before. [`AppearanceError::Full`] when a new reference
    /// finds no number; the map is as before, and the state is updated.
    pub fn update(&mut self, view: D) -> Result<UpdateOutcome, AppearanceError> {
        self.update_with(view, &[])
    }

    /// The robot sees `view`, and other sources say where it may be as well.
    ///
    /// # Errors
    /// As for [`update`](Self::update), and when a source fails.
    pub fn update_with(
        &mut self,
        view: D,
        sources: &[&dyn PoseSource],
    ) -> Result<UpdateOutcome, AppearanceError> {
        let is_news = self.is_news();
        let seen = if is_news { self.observe(&view)? } else { Observed::nothing() };
        let mut hypotheses = self.state.as_ref().map(PoseHypothesis::of_mixture).unwrap_or_default();
        let fusion = FusionParams { weighting: self.weighting(), ..self.params.fusion };
        hypotheses = fuse(&hypotheses, &seen.hypotheses, &fusion)?;
        for source in sources {
            hypotheses = fuse(&hypotheses, &source.hypotheses(self.state.as_ref())?, &fusion)?;
        }
        let anywhere =
            if is_news { self.anywhere.after(fusion.weighting, &hypotheses) } else { self.anywhere };
        let fused = if hypotheses.is_empty() {
            None
        } else {
            Some(PoseHypothesis::into_mixture(simplify(hypotheses, &self.simplification())?)?)
        };
        let mut events = self.change_of(fused.as_ref(), anywhere)?;
        (self.state, self.anywhere) = (fused, anywhere);
        self.doubt = self.doubt.after(seen.fit, &self.params.relocation);
        if is_news {
            if self.params.learning == Learning::Adapting {
                self.learn(view, &mut events)?;
            }
            self.motion = Motion::none();
            self.has_seen = true;
        }
        let estimate = self.one_place().cloned();
        Ok(UpdateOutcome { events, estimate, n_sightings: seen.n_sightings })
    }

    /// Learns that `view` is seen from `pose`, which is known: the map is taught, the state is not touched.
    ///
    /// # Errors
    /// When the pose has no meaning or the map is full.
    pub fn teach(&mut self, view: D, pose: &Gaussian<Pose2<f64>>) -> Result<ReferenceId, AppearanceError> {
        let way = self.taught_last.map_or(0.0, |last| (pose.mean().translation - last.translation).norm());
        let id = self.map.teach(view.clone(), pose)?;
        self.taught_last = Some(*pose.mean());
        self.measure(way, &view, Some(pose.mean()));
        Ok(id)
    }

    /// What becomes of the state with this mixture.
    fn change_of(
        &mut self,
        fused: Option<&Mixture<Pose2<f64>>>,
        anywhere: Anywhere,
    ) -> Result<Vec<Event>, AppearanceError> {
        let now = fused
            .filter(|_| anywhere.is_little())
            .and_then(|mixture| unimodal(mixture, &self.params.unimodal));
        let mut events = Vec::new();
        match (self.was_unimodal, now) {
            (true, None) => events.push(Event::Lost),
            (false, Some(_)) => events.push(Event::Found),
            _ => {}
        }
        let followed = self.state.as_ref().and_then(|state| state.components().first());
        if let (Some(now), Some(followed)) =
            (fused.and_then(|mixture| mixture.components().first()), followed)
        {
            self.corrected += (now.mean().translation - followed.mean().translation).norm();
            if separation_squared(now, followed)? > self.params.fusion.gate {
                events.push(Event::Relocated);
            }
        }
        self.was_unimodal = now.is_some();
        Ok(events)
    }
}
