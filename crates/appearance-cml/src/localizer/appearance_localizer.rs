use wayfix_estimation_traits::Pose2;
use wayfix_gaussian_core::{Gaussian, GaussianMixture};

use super::belief::Belief;
use super::contest::Contest;
use super::journey::Journey;
use super::scale_learner::ScaleLearner;
use super::survey::Survey;
use super::trail::Trail;
use super::{Event, Learning, LocalizerParams, Motion, Start, UpdateOutcome};
use crate::{
    AppearanceMap, AppearanceMapError, Descriptor, LinearSearch, PoseSource, ReferenceId, ReferenceSearch,
    separation_squared,
};

/// Localizes in an appearance map, and learns it. [Gross et al. 2005]
///
/// [`predict`](Self::predict) with each odometry increment, [`update`](Self::update) with each view. With an empty map and a known start the
/// map is built as the robot goes; [`teach`](Self::teach) builds one from known poses.
///
/// ```
/// # use wayfix_appearance_cml::{ViewDifference, Descriptor};
/// # #[derive(Clone, Debug)]
/// # struct Brightness(f64);
/// # impl Descriptor for Brightness {
/// #     fn compare(&self, other: &Self) -> ViewDifference {
/// #         ViewDifference { distance: (self.0 - other.0).abs(), rotation: 0.0 }
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
/// # Ok::<(), wayfix_appearance_cml::AppearanceMapError>(())
/// ```
#[derive(Clone, Debug)]
pub struct AppearanceLocalizer<D, S = LinearSearch<D>> {
    pub(super) params: LocalizerParams,
    pub(super) map: AppearanceMap<D, S>,
    pub(super) belief: Belief,
    pub(super) contest: Contest,
    /// Since the last view.
    pub(super) motion: Motion,
    pub(super) journey: Journey<D>,
    pub(super) scale_learner: ScaleLearner<D>,
    /// The last view that was used.
    pub(super) last_seen: Option<D>,
    /// The last view that was learned.
    pub(super) learned_last: Option<D>,
    pub(super) taught_last: Option<Pose2<f64>>,
    pub(super) was_unimodal: bool,
    pub(super) has_seen: bool,
    pub(super) trail: Trail,
    /// How far views have moved the estimate since the way behind was revised, m.
    pub(super) corrected: f64,
    pub(super) since_revision: usize,
    pub(super) survey: Survey,
    /// Counts views, to pick another far reference with each.
    pub(super) views: u32,
}

impl<D: Descriptor + Clone, S: ReferenceSearch<D> + Default> AppearanceLocalizer<D, S> {
    /// A localizer without a map.
    ///
    /// # Errors
    /// When a parameter or the start has no meaning.
    pub fn new(params: LocalizerParams, start: Start) -> Result<Self, AppearanceMapError> {
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
    ) -> Result<Self, AppearanceMapError> {
        params.validate()?;
        let belief = Belief::of_start(start)?;
        let was_unimodal = belief.state.is_some();
        Ok(Self {
            params,
            map,
            belief,
            contest: Contest::default(),
            motion: Motion::none(),
            journey: Journey::default(),
            scale_learner: ScaleLearner::default(),
            last_seen: None,
            learned_last: None,
            taught_last: None,
            was_unimodal,
            has_seen: false,
            trail: Trail::default(),
            corrected: 0.0,
            since_revision: 0,
            survey: Survey::default(),
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
    pub fn state(&self) -> Option<&GaussianMixture<Pose2<f64>>> {
        self.belief.state.as_ref()
    }
    /// The heaviest hypothesis.
    pub fn estimate(&self) -> Option<&Gaussian<Pose2<f64>>> {
        self.belief.heaviest()
    }

    /// Puts the robot somewhere else; what waits to be learned is given up.
    ///
    /// # Errors
    /// When the start has no meaning.
    pub fn restart(&mut self, start: Start) -> Result<(), AppearanceMapError> {
        self.belief = Belief::of_start(start)?;
        self.was_unimodal = self.belief.state.is_some();
        self.contest = Contest::default();
        self.motion = Motion::none();
        self.has_seen = false;
        self.journey = Journey::default();
        self.trail = Trail::default();
        self.survey = Survey::default();
        (self.corrected, self.since_revision) = (0.0, 0);
        self.scale_learner.interrupt();
        self.last_seen = None;
        self.learned_last = None;
        Ok(())
    }

    /// The robot has moved by `increment`, in the body frame at its beginning.
    ///
    /// # Errors
    /// When the increment is not finite; the state is as before.
    pub fn predict(&mut self, increment: &Pose2<f64>) -> Result<(), AppearanceMapError> {
        let noise = &self.params.odometry;
        let motion = self.motion.then(increment, noise)?;
        let belief = self.belief.moved(increment, noise)?;
        self.contest = self.contest.moved(increment, noise);
        (self.belief, self.motion) = (belief, motion);
        Ok(())
    }

    /// The robot sees `view`.
    ///
    /// # Errors
    /// When the belief has become singular or something is not finite; state and map are as before. [`AppearanceMapError::ReferenceIdsExhausted`] when a new reference
    /// finds no number; the map is as before, and the state is updated.
    pub fn update(&mut self, view: D) -> Result<UpdateOutcome, AppearanceMapError> {
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
    ) -> Result<UpdateOutcome, AppearanceMapError> {
        let is_news = self.is_news();
        let (mut belief, n_sightings) = self.seen(&self.belief, is_news.then_some(&view), sources)?;
        let mut contest = None;
        if is_news {
            let (decided, believed) = self.contested(&view, &belief).decided(belief, &self.params);
            (contest, belief) = (Some(decided), believed);
        }
        let mut events = self.change_to(&belief)?;
        self.belief = belief;
        if let Some(contest) = contest {
            self.contest = contest;
        }
        if is_news {
            self.last_seen = Some(view.clone());
            self.has_seen = true;
            let is_adapting = self.params.learning == Learning::Adapting;
            let learned = if is_adapting { self.learn(view, &mut events) } else { Ok(()) };
            self.motion = Motion::none();
            learned?;
        }
        let estimate = self.belief.one_place(&self.params.unimodal).cloned();
        Ok(UpdateOutcome { events, estimate, n_sightings })
    }

    /// Learns that `view` is seen from `pose`, which is known: the map is taught, the state is not touched.
    ///
    /// # Errors
    /// When the pose has no meaning or the map is full.
    pub fn teach(&mut self, view: D, pose: &Gaussian<Pose2<f64>>) -> Result<ReferenceId, AppearanceMapError> {
        let way = self.taught_last.map_or(0.0, |last| (pose.mean().translation - last.translation).norm());
        let id = self.map.teach(view.clone(), pose)?;
        self.taught_last = Some(*pose.mean());
        self.measure(way, &view, Some(pose.mean()));
        Ok(id)
    }

    /// What changes with this belief.
    fn change_to(&mut self, belief: &Belief) -> Result<Vec<Event>, AppearanceMapError> {
        let is_unimodal = belief.one_place(&self.params.unimodal).is_some();
        let mut events = Vec::new();
        match (self.was_unimodal, is_unimodal) {
            (true, false) => events.push(Event::Lost),
            (false, true) => events.push(Event::Found),
            _ => {}
        }
        if let (Some(now), Some(followed)) = (belief.heaviest(), self.belief.heaviest()) {
            let correction = (now.mean().translation - followed.mean().translation).norm();
            let is_elsewhere = separation_squared(now, followed)? > self.params.fusion.gate;
            self.corrected = if is_elsewhere { 0.0 } else { self.corrected + correction };
            events.extend(is_elsewhere.then_some(Event::Relocated));
        }
        self.was_unimodal = is_unimodal;
        Ok(events)
    }
}
