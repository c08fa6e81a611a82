use wayfix_estimation_traits::{MotionModel, Pose2};
use wayfix_gaussian_core::Gaussian;

use super::pose_history::PoseHistory;
use super::{AppearanceLocalizer, LocalizerEvent};
use crate::state::Motion;
use crate::{AppearanceMapError, ReferenceSearch, ViewDescriptor};

impl<D: ViewDescriptor + Clone, S: ReferenceSearch<D>, M> AppearanceLocalizer<D, S, M>
where
    M: MotionModel<State = Pose2<f64>, Control = Pose2<f64>>,
{
    /// Learns the views that the robot has left behind. [Gross et al. 2005, Secs. 2.1 and 2.3, Eqs. 11–19]
    ///
    /// A view waits until it is a match radius away: then no view that matches it can confirm its pose. It waits longer while the belief is
    /// not unimodal or the previous hypothesis may return, and is given up after the distance for which that one is kept.
    pub(super) fn learn(
        &mut self,
        view: D,
        motion: &Motion,
        events: &mut Vec<LocalizerEvent>,
    ) -> Result<(), AppearanceMapError> {
        let estimate = self.one_place().cloned();
        if events.contains(&LocalizerEvent::Relocated) {
            self.history = PoseHistory::default();
            self.learned_last = None;
        }
        let min_distance = self.map.scale().step() / 2.0;
        let at = estimate.as_ref().map(|estimate| *estimate.mean());
        if self.history.push(motion, min_distance, estimate, view.clone())? {
            self.measure(motion.distance(), &view, at.as_ref());
        }
        let delay = self.map.match_radius(&self.params.map);
        let max_delay = delay + self.params.relocalization.alternative_kept_distance;
        // Two views at most, so that no step takes much longer than the others.
        for _ in 0..2 {
            if self.history.length() <= delay {
                break;
            }
            let pose = self.history.oldest_pose().filter(|_| !self.kidnap.keeps_previous());
            if pose.is_none() && self.history.length() <= max_delay {
                break;
            }
            self.learn_oldest(pose, events)?;
        }
        Ok(())
    }

    /// Learns the oldest view, or gives it up if its pose is unknown or it is an outlier.
    fn learn_oldest(
        &mut self,
        pose: Option<Gaussian<Pose2<f64>>>,
        events: &mut Vec<LocalizerEvent>,
    ) -> Result<(), AppearanceMapError> {
        let is_outlier = self.params.skip_outlier_views_in_mapping && self.is_outlier();
        let Some(view) = self.history.pop() else { return Ok(()) };
        self.learned_last = Some(view.clone());
        let Some(pose) = pose.filter(|_| !is_outlier) else { return Ok(()) };
        let learned = self.map.learn(view, &pose, &self.params.map, self.params.fusion.gate)?;
        events.extend(learned.inserted.map(LocalizerEvent::NewReference));
        events.extend(learned.forgotten.into_iter().map(LocalizerEvent::Forgotten));
        Ok(())
    }

    /// Whether the oldest view differs from both neighbours along the path by twice the difference of successive views: as much as from a view
    /// four steps away. A person who passes by is in one view only; a lamp that is switched on stays on.
    fn is_outlier(&self) -> bool {
        let Some((view, next)) = self.history.oldest() else { return false };
        let (step, difference) = (self.map.scale().step(), self.map.scale().step_distance());
        let differs = |other: &D| view.compare(other).distance > 2.0 * difference;
        // A view further away differs anyway.
        let next = next.filter(|(_, distance)| *distance <= 2.0 * step).map(|(next, _)| next);
        let mut neighbours = self.learned_last.as_ref().into_iter().chain(next).peekable();
        neighbours.peek().is_some() && neighbours.all(differs)
    }

    /// Adds a view to the statistics of view differences.
    pub(super) fn measure(&mut self, distance: f64, view: &D, at: Option<&Pose2<f64>>) {
        self.scale_learner.observe(distance, view, self.map.scale_mut());
        let sample = self.map.sample(view, self.n_views, 1);
        let far = at.and_then(|pose| self.map.far_from(pose, &sample).next());
        if let Some(far) = far {
            self.map.scale_mut().add_far(far);
        }
    }
}
