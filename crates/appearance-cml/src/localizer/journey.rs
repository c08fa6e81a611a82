use std::collections::VecDeque;

use wayfix_estimation_traits::Pose2;
use wayfix_gaussian_core::Gaussian;

use super::{Motion, smooth};
use crate::ReferenceId;

/// One view along the way.
#[derive(Clone, Debug)]
struct Stop<D> {
    /// From the stop before.
    motion: Motion,
    /// Where the view was seen from as it was believed then, if that was one place.
    estimate: Option<Gaussian<Pose2<f64>>>,
    /// The view, while it waits to be learned.
    view: Option<D>,
    /// The reference that it became, and the pose that this was given.
    made: Option<(ReferenceId, Pose2<f64>)>,
}

/// A view, and the motion that led to it.
type Seen<'a, D> = (&'a D, Motion);

/// A reference whose pose is known better now.
#[derive(Clone, Debug, PartialEq)]
pub(super) struct Revision {
    pub(super) id: ReferenceId,
    /// What it was thought to be.
    pub(super) before: Pose2<f64>,
    pub(super) after: Gaussian<Pose2<f64>>,
}

/// The way of the robot: views that wait to be learned, and where those were seen that have become references.
///
/// Views are learned only when later ones have confirmed or corrected their poses. [Gross et al. 2005, Sec. 2.1]
/// Beyond the paper the way remains known behind them: when the robot comes back to a place that it knows better, the correction is spread over
/// the whole way since, and the references made there move.
#[derive(Clone, Debug)]
pub(super) struct Journey<D> {
    stops: VecDeque<Stop<D>>,
    n_waiting: usize,
}

impl<D> Default for Journey<D> {
    fn default() -> Self {
        Self { stops: VecDeque::new(), n_waiting: 0 }
    }
}

impl<D> Journey<D> {
    pub(super) fn push(&mut self, motion: Motion, estimate: Option<Gaussian<Pose2<f64>>>, view: D) {
        self.stops.push_back(Stop { motion, estimate, view: Some(view), made: None });
        self.n_waiting += 1;
    }

    pub(super) fn n_waiting(&self) -> usize {
        self.n_waiting
    }

    /// The pose was wrong all along: nothing of what waits can be learned, nothing of what was can be corrected; only the newest view remains.
    pub(super) fn keep_newest(&mut self) {
        let newest = self.stops.pop_back();
        self.stops.clear();
        self.stops.extend(newest);
        self.n_waiting = self.stops.len();
    }

    /// Forgets the way behind the last `most` stops.
    pub(super) fn shorten(&mut self, most: usize) {
        while self.stops.len() > most.max(self.n_waiting) {
            self.stops.pop_front();
        }
    }

    /// The oldest view that waits, the motion that led to it, and the view after it with the motion that leads there.
    pub(super) fn oldest_waiting(&self) -> Option<(Seen<'_, D>, Option<Seen<'_, D>>)> {
        let index = self.oldest_index()?;
        let view = |index: usize| {
            let stop = self.stops.get(index)?;
            Some((stop.view.as_ref()?, stop.motion))
        };
        Some((view(index)?, view(index + 1)))
    }

    /// Whether the robot is as sure of its place now as it was at the oldest view that waits, so that what has come since has told all of that pose that it
    /// will. Not in a place that nothing is known of: there only odometry speaks, until the robot is somewhere else that it knows.
    pub(super) fn is_surer_now(&self) -> bool {
        let at = |index: usize| {
            let estimate = self.stops.get(index)?.estimate.as_ref()?;
            Some(estimate.covariance().fixed_view::<2, 2>(0, 0).trace())
        };
        let then = self.oldest_index().and_then(at);
        let now = self.stops.len().checked_sub(1).and_then(at);
        match (then, now) {
            (Some(then), Some(now)) => now <= then,
            (None, Some(_)) => true,
            (_, None) => false,
        }
    }

    /// Where the oldest view that waits was seen from, by all views up to the newest that is at one place; `None` when none is.
    pub(super) fn settled_pose(&self) -> Option<Gaussian<Pose2<f64>>> {
        self.smoothed_from(self.oldest_index()?)?.into_iter().next()
    }

    /// Takes the oldest view out to be learned, or to be given up.
    pub(super) fn take_oldest(&mut self) -> Option<D> {
        let index = self.oldest_index()?;
        self.n_waiting -= 1;
        self.stops.get_mut(index)?.view.take()
    }

    /// The view that was taken out last has become this reference.
    pub(super) fn made(&mut self, id: ReferenceId, at: Pose2<f64>) {
        let learned = self.stops.len() - self.n_waiting;
        if let Some(stop) = learned.checked_sub(1).and_then(|index| self.stops.get_mut(index)) {
            stop.made = Some((id, at));
        }
    }

    /// Spreads what is known now over the whole way, and says which references have moved.
    pub(super) fn revise(&mut self) -> Vec<Revision> {
        let first = self.stops.iter().position(|stop| stop.estimate.is_some());
        let Some((first, smoothed)) = first.and_then(|first| Some((first, self.smoothed_from(first)?)))
        else {
            return Vec::new();
        };
        let mut revisions = Vec::new();
        for (stop, after) in self.stops.iter_mut().skip(first).zip(smoothed) {
            if let Some((id, at)) = &mut stop.made {
                revisions.push(Revision { id: *id, before: *at, after: after.clone() });
                *at = *after.mean();
            }
        }
        revisions
    }

    fn oldest_index(&self) -> Option<usize> {
        if self.n_waiting == 0 { None } else { self.stops.len().checked_sub(self.n_waiting) }
    }

    /// Smoothed poses from one stop to the newest at one place. Stops without an estimate of their own are reconstructed by odometry from the
    /// one before, and where there is none, back from the first that has one.
    fn smoothed_from(&self, first: usize) -> Option<Vec<Gaussian<Pose2<f64>>>> {
        let newest = self.stops.iter().rposition(|stop| stop.estimate.is_some())?;
        if newest < first {
            return None;
        }
        let known = (0..=first).rev().find(|index| self.stops[*index].estimate.is_some());
        let Some(known) = known else {
            return self.reconstructed_back(first).map(|pose| vec![pose]);
        };
        let mut filtered: Vec<Gaussian<Pose2<f64>>> = Vec::with_capacity(newest + 1 - known);
        for stop in self.stops.range(known..=newest) {
            let moved = || filtered.last().map(|before| stop.motion.applied(before));
            filtered.push(stop.estimate.clone().or_else(moved)?);
        }
        let motions: Vec<Motion> = self.stops.range(known + 1..=newest).map(|stop| stop.motion).collect();
        // A smoother that fails on a degenerate covariance leaves what the filter said.
        let smoothed = smooth(&filtered, &motions).unwrap_or(filtered);
        Some(smoothed.into_iter().skip(first - known).collect())
    }

    /// A pose before the first that is known, from there back by odometry.
    fn reconstructed_back(&self, first: usize) -> Option<Gaussian<Pose2<f64>>> {
        let known = (first..self.stops.len()).find(|index| self.stops[*index].estimate.is_some())?;
        let mut pose = self.stops[known].estimate.clone()?;
        for stop in self.stops.range(first + 1..=known).rev() {
            pose = stop.motion.undone(&pose);
        }
        Some(pose)
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::OdometryNoise;
    use nalgebra::Vector3;

    fn at(x: f64) -> Gaussian<Pose2<f64>> {
        let sigmas = Vector3::new(1e-3, 1e-3, 1e-3);
        Gaussian::from_sigmas(Pose2::new(x, 0.0, 0.0), &sigmas).expect("sigmas are positive")
    }

    fn metre() -> Motion {
        let increment = Pose2::new(1.0, 0.0, 0.0);
        Motion::none().then(&increment, &OdometryNoise::default()).expect("a finite increment")
    }

    #[test]
    fn a_correction_at_the_end_moves_what_was_made_on_the_way() {
        let mut journey = Journey::default();
        let mut belief = at(0.0);
        journey.push(Motion::none(), Some(belief.clone()), ());
        for _ in 0..3 {
            belief = metre().applied(&belief);
            journey.push(metre(), Some(belief.clone()), ());
        }
        for id in 0..3 {
            let pose = journey.settled_pose().unwrap();
            journey.take_oldest();
            journey.made(ReferenceId(id), *pose.mean());
        }
        // Odometry says 4 m; each metre is equally in doubt, so that each is corrected by the same.
        journey.push(metre(), Some(at(4.4)), ());
        let revisions = journey.revise();
        assert_eq!(revisions.len(), 3);
        for (k, revision) in revisions.iter().enumerate() {
            assert!((revision.before.x() - k as f64).abs() < 1e-9);
            assert!((revision.after.mean().x() - 1.1 * k as f64).abs() < 0.01, "{revision:?}");
        }
        assert!(
            journey.revise().iter().all(|r| (r.after.mean().x() - r.before.x()).abs() < 1e-9),
            "only once"
        );
    }

    #[test]
    fn states_between_two_known_ones_and_before_the_first_are_reconstructed() {
        let mut journey = Journey::default();
        journey.push(Motion::none(), None, ());
        assert!(journey.settled_pose().is_none(), "nothing is known yet");
        journey.push(metre(), Some(at(5.0)), ());
        journey.push(metre(), None, ());
        journey.push(metre(), Some(at(7.2)), ());
        let mut settled = Vec::new();
        while let Some(pose) = journey.settled_pose() {
            settled.push(pose.mean().x());
            journey.take_oldest();
        }
        assert_eq!(settled.len(), 4);
        for (x, expected) in settled.iter().zip([4.0, 5.0, 6.1, 7.2]) {
            assert!((x - expected).abs() < 0.01, "{settled:?}");
        }
    }

    #[test]
    fn who_comes_to_a_known_place_is_surer_than_who_waits() {
        let mut journey = Journey::default();
        assert!(!journey.is_surer_now(), "nothing waits");
        let (start, unsure) = (at(0.0), metre().applied(&at(0.0)));
        journey.push(Motion::none(), Some(unsure.clone()), ());
        assert!(journey.is_surer_now(), "as sure as it is itself");
        journey.push(metre(), Some(metre().applied(&unsure)), ());
        assert!(!journey.is_surer_now(), "odometry alone");
        journey.push(metre(), None, ());
        assert!(!journey.is_surer_now(), "it does not know where it is");
        journey.push(metre(), Some(start), ());
        assert!(journey.is_surer_now(), "a known place");
        let mut lost = Journey::default();
        lost.push(Motion::none(), None, ());
        lost.push(metre(), Some(unsure), ());
        assert!(lost.is_surer_now(), "anything is surer than not to know");
    }

    #[test]
    fn a_way_that_was_wrong_keeps_its_newest_view_only() {
        let mut journey = Journey::default();
        for k in 0..5 {
            journey.push(metre(), Some(at(f64::from(k))), k);
        }
        journey.take_oldest();
        journey.keep_newest();
        assert_eq!((journey.n_waiting(), journey.take_oldest(), journey.take_oldest()), (1, Some(4), None));
    }
}
