use wayfix_estimation_traits::Pose2;
use wayfix_gaussian_core::Gaussian;

use super::compass::MOST_LEARNED_SIGMA;
use super::{AppearanceLocalizer, Event};
use crate::{AppearanceMapError, Descriptor, ReferenceSearch};

/// Views that are learned with one view at most: what has waited is made up for without a step that takes many times as long as others.
const MOST_AT_ONCE: usize = 8;
/// Views between two revisions of the way behind, at least: a correction that comes in pieces is spread once.
const REVISION_VIEWS: usize = 20;
/// Correction that is worth a revision, in steps between views.
const REVISION_SHARE: f64 = 0.5;
/// How near to a surveyed reference the robot is where the map was surveyed, in reaches of a match: less than what the trail holds.
const SURVEYED_REACHES: f64 = 1.5;

impl<D: Descriptor + Clone, S: ReferenceSearch<D>> AppearanceLocalizer<D, S> {
    /// The view joins the way, and those that have waited long enough are learned.
    pub(super) fn learn(&mut self, view: D, events: &mut Vec<Event>) -> Result<(), AppearanceMapError> {
        let estimate = self.belief.one_place(&self.params.unimodal).cloned();
        let way = self.motion.increment.translation.norm();
        self.trail.moved(way, self.map.match_radius(&self.params.map));
        self.measure(way, &view, estimate.as_ref().map(Gaussian::mean));
        self.journey.push(self.motion, estimate, view);
        if events.contains(&Event::Relocated) {
            self.journey.keep_newest();
            self.learned_last = None;
        }
        for _ in 0..MOST_AT_ONCE {
            if self.journey.n_waiting() <= self.params.delay || self.awaits_correction() {
                break;
            }
            let settled = self.journey.settled_pose().filter(|_| !self.contest.is_open());
            if settled.is_none() && self.journey.n_waiting() <= self.params.longest_wait {
                break;
            }
            self.learn_oldest(settled, events)?;
        }
        self.journey.shorten(self.params.memory.max(1));
        if self.params.memory > 0 {
            self.revise_when_due();
        }
        Ok(())
    }

    /// Whether to wait for what a place that the robot comes to says of the view that has waited longest. Only where the map was surveyed: one that the robot
    /// builds on its way errs with it, and would miss what has just been seen.
    fn awaits_correction(&self) -> bool {
        self.journey.n_waiting() <= self.params.patience
            && !self.journey.is_surer_now()
            && self.surveyed_place().is_some()
    }

    /// Where the robot is, if the map was surveyed around it and not just made by it on its way.
    fn surveyed_place(&self) -> Option<Pose2<f64>> {
        let at = self.belief.heaviest()?.mean();
        let is_surveyed =
            self.map.has_known_heading_near(at, (self.surveyed_radius(), MOST_LEARNED_SIGMA), |id| {
                !self.trail.holds(id)
            });
        is_surveyed.then_some(*at)
    }

    fn surveyed_radius(&self) -> f64 {
        SURVEYED_REACHES * self.map.match_radius(&self.params.map)
    }

    /// Learns the view that has waited longest; gives it up when it is nowhere, or an outlier.
    fn learn_oldest(
        &mut self,
        settled: Option<Gaussian<Pose2<f64>>>,
        events: &mut Vec<Event>,
    ) -> Result<(), AppearanceMapError> {
        let is_corroborated = self.is_corroborated();
        let Some(view) = self.journey.take_oldest() else { return Ok(()) };
        if let Some(pose) = settled.filter(|_| is_corroborated) {
            let learned = self.map.learn(view.clone(), &pose, &self.params.map)?;
            if let Some(id) = learned.inserted {
                self.journey.made(id, *pose.mean());
                self.trail.made(id);
                events.push(Event::NewReference(id));
            }
            events.extend(learned.forgotten.into_iter().map(Event::Forgotten));
        }
        self.learned_last = Some(view);
        Ok(())
    }

    /// Whether the view before or after looks like the one that has waited longest. Somebody who passes by is in one view and gone in the
    /// next; a lamp that is switched on stays on.
    fn is_corroborated(&self) -> bool {
        let Some(factor) = self.params.corroboration else { return true };
        let Some(((view, motion), after)) = self.journey.oldest_waiting() else { return true };
        let (step, scale) = (self.map.scale().step(), self.map.scale().step_distance());
        // Over a longer way a view may differ by more, and proves nothing.
        let agrees = |other: &D, way: f64| way > 1.5 * step || view.compare(other).distance <= factor * scale;
        let before = self.learned_last.as_ref().map(|last| (last, motion));
        let mut neighbours = before.into_iter().chain(after).peekable();
        neighbours.peek().is_none()
            || neighbours.any(|(other, motion)| agrees(other, motion.increment.translation.norm()))
    }

    /// Corrections add up until they are worth a walk over the whole way. Only where surveyed references lie around: where the robot has built the map, a loop
    /// that is closed wrongly would bend the whole way behind it.
    fn revise_when_due(&mut self) {
        self.since_revision += 1;
        let Some(at) = self.surveyed_place() else { return };
        self.survey.passed(&at, self.surveyed_radius());
        let is_worth_it = self.corrected >= REVISION_SHARE * self.map.scale().step();
        let is_due = self.since_revision >= REVISION_VIEWS && is_worth_it;
        if !is_due || !self.survey.is_wide() || self.contest.is_open() {
            return;
        }
        (self.since_revision, self.corrected) = (0, 0.0);
        for revision in self.journey.revise() {
            self.map.revise(revision.id, &revision.before, &revision.after);
        }
    }

    /// Measures how views change with the way.
    pub(super) fn measure(&mut self, way: f64, view: &D, at: Option<&Pose2<f64>>) {
        self.scale_learner.observe(way, view, self.map.scale_mut());
        self.views = self.views.wrapping_add(1);
        let Some(distance) = at.and_then(|pose| self.map.distance_to_far(view, pose, self.views)) else {
            return;
        };
        self.map.scale_mut().add_far(distance);
    }
}
