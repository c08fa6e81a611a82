use wayfix_estimation_traits::Pose2;
use wayfix_gaussian_core::{Gaussian, Mixture};

use super::queue::{LearningQueue, Waiting};
use super::scale_learner::ScaleLearner;
use super::trail::Trail;
use super::{Event, Learning, LocalizerParams, Motion, Observation, UpdateOutcome};
use crate::{
    AppearanceError, AppearanceMap, Descriptor, LinearSearch, PoseHypothesis, PoseSource, ReferenceId,
    ReferenceSearch, fuse, interpolate, propagate, separation_squared, simplify, superpose, unimodal,
};

/// Where the robot is when it is switched on.
#[derive(Clone, Debug, PartialEq)]
pub enum Start {
    /// There, in the frame of the map.
    Known(Gaussian<Pose2<f64>>),
    /// In one of several places, as a state that was saved says.
    Among(Mixture<Pose2<f64>>),
    /// Anywhere in the map.
    Anywhere,
}

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
    params: LocalizerParams,
    map: AppearanceMap<D, S>,
    state: Option<Mixture<Pose2<f64>>>,
    /// Since the last view.
    motion: Motion,
    queue: LearningQueue<D>,
    scale_learner: ScaleLearner<D>,
    /// The last view that left the queue.
    learned_last: Option<D>,
    taught_last: Option<Pose2<f64>>,
    was_unimodal: bool,
    trail: Trail,
    /// Counts views, to pick another far reference with each.
    views: u32,
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
        let state = state_at(start)?;
        let was_unimodal = state.is_some();
        Ok(Self {
            params,
            map,
            state,
            motion: Motion::none(),
            queue: LearningQueue::default(),
            scale_learner: ScaleLearner::default(),
            learned_last: None,
            taught_last: None,
            was_unimodal,
            trail: Trail::default(),
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
        self.state = state_at(start)?;
        self.was_unimodal = self.state.is_some();
        self.motion = Motion::none();
        self.queue = LearningQueue::default();
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
    /// When a belief has become singular or something is not finite; state and map are as before.
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
        let (observed, n_sightings) = self.observe(&view)?;
        let mut hypotheses = self.state.as_ref().map(PoseHypothesis::of_mixture).unwrap_or_default();
        hypotheses = fuse(&hypotheses, &observed, &self.params.fusion)?;
        for source in sources {
            hypotheses = fuse(&hypotheses, &source.hypotheses(self.state.as_ref())?, &self.params.fusion)?;
        }
        let fused = if hypotheses.is_empty() {
            None
        } else {
            Some(PoseHypothesis::into_mixture(simplify(hypotheses, &self.params.simplify)?)?)
        };
        let mut events = self.change_of(fused.as_ref())?;
        self.state = fused;
        if self.params.learning == Learning::Adapting {
            self.learn(view, &mut events)?;
        }
        self.motion = Motion::none();
        let estimate = self.one_place().cloned();
        Ok(UpdateOutcome { events, estimate, n_sightings })
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

    /// $`p(x_t | y_t)`$, and how many places it is made of.
    fn observe(&self, view: &D) -> Result<(Vec<PoseHypothesis>, usize), AppearanceError> {
        let params = &self.params;
        match params.observation {
            Observation::Superposition => {
                let sightings = self.map.all_sightings(view, &params.map);
                Ok((superpose(&sightings), sightings.len()))
            }
            Observation::Interpolation => {
                let mut sightings =
                    self.map.sightings(view, self.state.as_ref(), params.most_matches, &params.map);
                sightings.retain(|s| !self.trail.holds(s.matched.id));
                let belief = self.state.as_ref().map_or(&[][..], Mixture::components);
                Ok((interpolate(&sightings, belief, self.map.scale())?, sightings.len()))
            }
        }
    }

    fn one_place(&self) -> Option<&Gaussian<Pose2<f64>>> {
        self.state.as_ref().and_then(|state| unimodal(state, &self.params.unimodal))
    }

    /// What becomes of the state with this mixture.
    fn change_of(&mut self, fused: Option<&Mixture<Pose2<f64>>>) -> Result<Vec<Event>, AppearanceError> {
        let now = fused.and_then(|mixture| unimodal(mixture, &self.params.unimodal));
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
            if separation_squared(now, followed)? > self.params.fusion.gate {
                events.push(Event::Relocated);
            }
        }
        self.was_unimodal = now.is_some();
        Ok(events)
    }

    fn learn(&mut self, view: D, events: &mut Vec<Event>) -> Result<(), AppearanceError> {
        let estimate = self.one_place().cloned();
        let way = self.motion.increment.translation.norm();
        self.trail.moved(way, self.map.reach_of_match(&self.params.map));
        self.measure(way, &view, estimate.as_ref().map(Gaussian::mean));
        self.queue.push(Waiting { view, motion: self.motion, estimate });
        if events.contains(&Event::Relocated) {
            self.queue.keep_newest();
            self.learned_last = None;
        }
        while self.queue.len() > self.params.delay {
            let Some((oldest, pose)) = self.queue.pop_settled() else {
                if self.queue.len() <= self.params.longest_wait {
                    break;
                }
                self.queue.drop_oldest();
                continue;
            };
            if self.is_corroborated(&oldest) {
                let learned = self.map.learn(oldest.view.clone(), &pose, &self.params.map)?;
                self.trail.extend(learned.inserted);
                events.extend(learned.inserted.map(Event::NewReference));
                events.extend(learned.forgotten.into_iter().map(Event::Forgotten));
            }
            self.learned_last = Some(oldest.view);
        }
        Ok(())
    }

    /// Whether the view before or after looks alike. Somebody who passes by is in one view and gone in the next; a lamp that is switched
    /// on stays on.
    fn is_corroborated(&self, oldest: &Waiting<D>) -> bool {
        let Some(factor) = self.params.corroboration else { return true };
        let (step, scale) = (self.map.scale().step(), self.map.scale().step_distance());
        let agrees = |other: &D, way: f64| {
            // Over a longer way a view may differ by more, and proves nothing.
            way > 1.5 * step || oldest.view.compare(other).distance <= factor * scale
        };
        let before = self.learned_last.as_ref().map(|view| (view, oldest.motion));
        let after = self.queue.first().map(|waiting| (&waiting.view, waiting.motion));
        let mut neighbours = before.into_iter().chain(after).peekable();
        neighbours.peek().is_none()
            || neighbours.any(|(view, motion)| agrees(view, motion.increment.translation.norm()))
    }

    /// Measures how views change with the way.
    fn measure(&mut self, way: f64, view: &D, at: Option<&Pose2<f64>>) {
        self.scale_learner.observe(way, view, self.map.scale_mut());
        self.views = self.views.wrapping_add(1);
        let Some(distance) = at.and_then(|pose| self.map.distance_to_far(view, pose, self.views)) else {
            return;
        };
        self.map.scale_mut().add_far(distance);
    }
}

fn state_at(start: Start) -> Result<Option<Mixture<Pose2<f64>>>, AppearanceError> {
    match start {
        Start::Anywhere => Ok(None),
        Start::Among(places) => Ok(Some(places)),
        Start::Known(pose) => {
            let (mean, covariance) = pose.into_parts();
            let checked = Gaussian::new(mean, covariance)?;
            Ok(Some(Mixture::from_weights(vec![(1.0, checked)])?))
        }
    }
}
