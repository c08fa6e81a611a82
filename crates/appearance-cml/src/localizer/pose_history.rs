use std::collections::VecDeque;

use wayfix_estimation_traits::Pose2;
use wayfix_gaussian_core::Gaussian;
use wayfix_kalman::RtsSmoother;

use crate::AppearanceMapError;
use crate::state::{Motion, RecordedMotion};

/// The views that wait to be learned, with their pose estimates and the odometry between them.
///
/// Views are learned with a delay, against feedback between the belief and the map. Poses between two unimodal estimates are reconstructed.
/// [Gross et al. 2005, Sec. 2.1]
#[derive(Clone, Debug)]
pub(super) struct PoseHistory<D> {
    waiting: VecDeque<Waiting<D>>,
    /// Since the newest view.
    motion: Motion,
}

#[derive(Clone, Debug)]
struct Waiting<D> {
    /// From the view before.
    motion: Motion,
    /// The pose estimate, if the belief was unimodal.
    estimate: Option<Gaussian<Pose2<f64>>>,
    view: D,
}

impl<D> Default for PoseHistory<D> {
    fn default() -> Self {
        Self { waiting: VecDeque::new(), motion: Motion::none() }
    }
}

impl<D> PoseHistory<D> {
    /// Adds a view after `motion`, unless it is nearer than `min_distance` to the newest one. Returns whether it did.
    pub(super) fn push(
        &mut self,
        motion: &Motion,
        min_distance: f64,
        estimate: Option<Gaussian<Pose2<f64>>>,
        view: D,
    ) -> Result<bool, AppearanceMapError> {
        self.motion = self.motion.then(motion)?;
        let is_new = self.waiting.is_empty() || self.motion.distance() >= min_distance;
        if is_new {
            let motion = std::mem::replace(&mut self.motion, Motion::none());
            self.waiting.push_back(Waiting { motion, estimate, view });
        }
        Ok(is_new)
    }

    /// Distance along the path from the oldest to the newest view, m.
    pub(super) fn length(&self) -> f64 {
        self.waiting.iter().skip(1).map(|waiting| waiting.motion.distance()).sum()
    }

    /// The oldest view, and the next one with the distance to it.
    pub(super) fn oldest(&self) -> Option<(&D, Option<(&D, f64)>)> {
        let next = self.waiting.get(1).map(|next| (&next.view, next.motion.distance()));
        Some((&self.waiting.front()?.view, next))
    }

    /// The pose of the oldest view given all estimates since, by the Rauch-Tung-Striebel smoother. `None` without any.
    pub(super) fn oldest_pose(&self) -> Option<Gaussian<Pose2<f64>>> {
        let is_known = |waiting: &Waiting<D>| waiting.estimate.is_some();
        let first = self.waiting.iter().position(is_known)?;
        let last = self.waiting.iter().rposition(is_known)?;
        let known = self.waiting.get(first)?.estimate.clone()?;
        let smoothed = self.smoothed(known.clone(), first..last + 1).unwrap_or(known);
        // Before the first estimate only odometry is known.
        Some(self.waiting.range(1..=first).rev().fold(smoothed, |pose, later| later.motion.undone(&pose)))
    }

    /// `None` if a covariance is degenerate.
    fn smoothed(
        &self,
        prior: Gaussian<Pose2<f64>>,
        range: std::ops::Range<usize>,
    ) -> Option<Gaussian<Pose2<f64>>> {
        let mut smoother = RtsSmoother::new(prior).ok()?;
        for waiting in self.waiting.range(range).skip(1) {
            smoother.predict(&RecordedMotion, &waiting.motion).ok()?;
            if let Some(estimate) = &waiting.estimate {
                smoother.set_filtered(estimate.clone()).ok()?;
            }
        }
        smoother.smoothed().ok()?.into_iter().next()
    }

    /// Removes the oldest view. Its estimate, moved by odometry, replaces a missing one of the next view.
    pub(super) fn pop(&mut self) -> Option<D> {
        let oldest = self.waiting.pop_front()?;
        if let (Some(next), Some(pose)) = (self.waiting.front_mut(), oldest.estimate) {
            next.estimate = next.estimate.take().or_else(|| next.motion.applied(&pose));
        }
        Some(oldest.view)
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::OdometryNoise;
    use approx::{abs_diff_eq, assert_abs_diff_eq};
    use nalgebra::Vector3;

    fn at(x: f64) -> Gaussian<Pose2<f64>> {
        let sigmas = Vector3::new(1e-3, 1e-3, 1e-3);
        Gaussian::from_sigmas(Pose2::new(x, 0.0, 0.0), &sigmas).expect("sigmas are positive")
    }

    fn metre() -> Motion {
        let increment = Pose2::new(1.0, 0.0, 0.0);
        Motion::of_increment(&OdometryNoise::default(), &Pose2::new(0.0, 0.0, 0.0), &increment)
    }

    fn history(estimates: &[Option<f64>]) -> PoseHistory<usize> {
        let mut history = PoseHistory::default();
        for (k, estimate) in estimates.iter().enumerate() {
            assert!(history.push(&metre(), 0.5, estimate.map(at), k).expect("a finite motion"));
        }
        history
    }

    fn settled(mut history: PoseHistory<usize>) -> Vec<f64> {
        let mut settled = Vec::new();
        while let Some(pose) = history.oldest_pose() {
            settled.push(pose.mean().x());
            history.pop();
        }
        settled
    }

    #[test]
    fn states_between_two_known_ones_and_before_are_reconstructed() {
        let poses = settled(history(&[None, Some(5.0), None, Some(7.2)]));
        assert_eq!(poses.len(), 4);
        for (x, expected) in poses.iter().zip([4.0, 5.0, 6.1, 7.2]) {
            assert!(abs_diff_eq!(*x, expected, epsilon = 0.01), "{poses:?}");
        }
        assert!(settled(history(&[None, None])).is_empty());
    }

    #[test]
    fn last_known_pose_goes_on_by_odometry() {
        let mut history = history(&[Some(1.0), None, None]);
        history.pop();
        assert_abs_diff_eq!(history.oldest_pose().expect("known").mean().x(), 2.0, epsilon = 1e-9);
        assert_eq!(history.length(), 1.0);
    }

    #[test]
    fn turning_on_the_spot_adds_no_view() {
        let mut history = history(&[Some(0.0)]);
        let turn = Pose2::new(0.0, 0.0, 0.2);
        let turn = Motion::of_increment(&OdometryNoise::default(), &Pose2::new(0.0, 0.0, 0.0), &turn);
        assert!(!history.push(&turn, 0.5, None, 1).expect("a finite motion"));
        assert!(history.push(&metre(), 0.5, None, 2).expect("a finite motion"));
        assert_eq!(history.length(), 1.0, "the turn is a part of the motion to the next view");
    }
}
