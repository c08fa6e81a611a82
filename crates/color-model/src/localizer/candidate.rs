use wayfix_estimation_traits::Pose2;

use super::trajectory::Trajectory;
use crate::PixelSums;

/// One of the places that were pursued before the search.
#[derive(Clone, Copy)]
pub(crate) struct Known {
    pub(crate) index: usize,
    pub(crate) place: Pose2<f64>,
}

/// A trajectory, and how well it explains the frames.
#[derive(Clone)]
pub(crate) struct Candidate {
    pub(crate) trajectory: Trajectory,
    /// What every colour shows in every frame: the colours of the first frame, then those of the next.
    pub(crate) sums: Vec<PixelSums>,
    /// What every frame says under every member of the lighting bank, where the light is known: the members of the first frame, then of the next.
    pub(crate) by_frame: Vec<f64>,
    /// Which frames are likely to be hidden if it is right.
    pub(crate) is_hidden: Vec<bool>,
    /// Log-likelihood under every member of the lighting bank.
    pub(crate) log_likelihoods: Vec<f64>,
    /// Log of likelihood and prior, nats.
    pub(crate) score: f64,
    /// Log of the prior of the first pose and of what went wrong since, nats.
    pub(crate) log_prior: f64,
    /// Length of its next step, as a share of the first.
    pub(crate) step: f64,
    /// The place that was pursued before the search and that it descends from, if any: it does not leave that.
    pub(crate) known: Option<Known>,
}

impl Candidate {
    /// What every frame shows.
    pub(crate) fn frames(&self, n_colors: usize) -> impl Iterator<Item = &[PixelSums]> {
        self.sums.chunks(n_colors.max(1))
    }

    /// The sums of all frames but the hidden ones.
    pub(crate) fn total(&self, is_hidden: &[bool], totals: &mut [PixelSums]) {
        totals.fill(PixelSums::default());
        for (frame, _) in self.frames(totals.len()).zip(is_hidden).filter(|(_, is_hidden)| !**is_hidden) {
            totals.iter_mut().zip(frame).for_each(|(total, sums)| total.add(sums));
        }
    }
}
