use std::collections::VecDeque;

use wayfix_estimation_traits::Pose2;
use wayfix_gaussian_core::Gaussian;

use super::{Motion, smooth};

/// A view that waits to be learned.
#[derive(Clone, Debug)]
pub(super) struct Waiting<D> {
    pub(super) view: D,
    /// From the view before.
    pub(super) motion: Motion,
    /// Where it was seen from, if that was one place.
    pub(super) estimate: Option<Gaussian<Pose2<f64>>>,
}

/// Views with the poses they were seen from, learned only when later views have confirmed or corrected these.
/// [Gross et al. 2005, Sec. 2.1]
#[derive(Clone, Debug)]
pub(super) struct LearningQueue<D> {
    waiting: VecDeque<Waiting<D>>,
    /// Pose of the last view that left the queue.
    anchor: Option<Gaussian<Pose2<f64>>>,
}

impl<D> Default for LearningQueue<D> {
    fn default() -> Self {
        Self { waiting: VecDeque::new(), anchor: None }
    }
}

impl<D> LearningQueue<D> {
    pub(super) fn push(&mut self, waiting: Waiting<D>) {
        self.waiting.push_back(waiting);
    }

    pub(super) fn len(&self) -> usize {
        self.waiting.len()
    }

    /// The pose was wrong all along: nothing of what waits can be learned, save what comes with the newest view.
    pub(super) fn keep_newest(&mut self) {
        let newest = self.waiting.pop_back();
        self.waiting.clear();
        self.waiting.extend(newest);
        self.anchor = None;
    }

    /// The oldest view.
    pub(super) fn first(&self) -> Option<&Waiting<D>> {
        self.waiting.front()
    }

    /// The oldest view with the pose that all views up to the newest unimodal one give it; `None` when there is no such pose yet.
    pub(super) fn pop_settled(&mut self) -> Option<(Waiting<D>, Gaussian<Pose2<f64>>)> {
        let pose = self.settled_pose()?;
        let oldest = self.waiting.pop_front()?;
        self.anchor = Some(oldest.estimate.clone().unwrap_or_else(|| pose.clone()));
        Some((oldest, pose))
    }

    /// Gives up the oldest view.
    pub(super) fn drop_oldest(&mut self) {
        self.waiting.pop_front();
        self.anchor = None;
    }

    fn settled_pose(&self) -> Option<Gaussian<Pose2<f64>>> {
        let newest_known = self.waiting.iter().rposition(|w| w.estimate.is_some())?;
        let span = || self.waiting.iter().take(newest_known + 1);
        let mut filtered: Vec<Gaussian<Pose2<f64>>> = Vec::with_capacity(newest_known + 1);
        for waiting in span() {
            let before = filtered.last().or(self.anchor.as_ref());
            let reconstructed = || before.map(|belief| waiting.motion.applied(belief));
            filtered.push(waiting.estimate.clone().or_else(reconstructed)?);
        }
        let motions: Vec<Motion> = span().skip(1).map(|w| w.motion).collect();
        // A smoother that fails on a degenerate covariance leaves what the filter said.
        let smoothed = smooth(&filtered, &motions).unwrap_or_else(|_| filtered.clone());
        smoothed.into_iter().next()
    }
}
