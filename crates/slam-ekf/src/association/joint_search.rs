use nalgebra::{DefaultAllocator, DimName};

use super::{
    candidates::{Candidate, Candidates},
    joint_innovation::JointInnovation,
};
use crate::{EkfSlam, LandmarkDim, LandmarkModel, MeasurementDim, PredictedMeasurement, RobotDim, SlamAlloc};

/// Depth-first over the observations that have candidates, each paired with one of them or with none.
pub(super) struct Search<'a, M: LandmarkModel>
where
    DefaultAllocator: SlamAlloc<RobotDim<M>, LandmarkDim<M>, MeasurementDim<M>>,
{
    filter: &'a EkfSlam<M>,
    predictions: &'a [PredictedMeasurement<M>],
    /// Observations with candidates, and their candidates.
    open: Vec<(usize, Vec<&'a Candidate<M>>)>,
    gates: &'a [f64],
    trials_left: usize,
    joint: JointInnovation,
    /// The paired candidate of every open observation so far.
    chosen: Vec<Option<&'a Candidate<M>>>,
    n_paired: usize,
    /// For every observation, the prediction that it is paired with in the best set so far.
    pub(super) best: Vec<Option<usize>>,
    best_score: (usize, f64),
}

impl<'a, M: LandmarkModel> Search<'a, M>
where
    DefaultAllocator: SlamAlloc<RobotDim<M>, LandmarkDim<M>, MeasurementDim<M>>,
{
    pub(super) fn new(
        filter: &'a EkfSlam<M>,
        candidates: &'a Candidates<M>,
        gates: &'a [f64],
        gate: f64,
        n_trials: usize,
    ) -> Self {
        let compatible = |(observation, all): (usize, &'a Vec<Candidate<M>>)| {
            let near: Vec<_> = all.iter().take_while(|candidate| candidate.innovation.nis <= gate).collect();
            (!near.is_empty()).then_some((observation, near))
        };
        let mut open: Vec<_> = candidates.of_observation.iter().enumerate().filter_map(compatible).collect();
        open.sort_by_key(|(_, near)| near.len()); // the least doubtful first: their pairings prune the others
        Self {
            filter,
            predictions: &candidates.predictions,
            open,
            gates,
            trials_left: n_trials.max(1),
            joint: JointInnovation::default(),
            chosen: Vec::new(),
            n_paired: 0,
            best: vec![None; candidates.of_observation.len()],
            best_score: (0, 0.0),
        }
    }

    pub(super) fn is_cut_short(&self) -> bool {
        self.trials_left == 0
    }

    /// Branch and bound without recursion: `next` is the next branch of each open observation.
    pub(super) fn run(&mut self) {
        let mut next = vec![0];
        while let (Some(branch), false) = (next.last_mut(), self.is_cut_short()) {
            let depth = self.chosen.len();
            let taken = *branch;
            *branch += 1;
            let n_candidates = self.open.get(depth).map_or(0, |(_, near)| near.len());
            let is_exhausted = depth == self.open.len() || taken > n_candidates || !self.can_improve();
            if is_exhausted {
                self.keep_if_best();
                next.pop();
                self.step_back();
            } else if self.step_down(self.open[depth].1.get(taken).copied()) {
                next.push(0);
            }
        }
        if self.is_cut_short() {
            self.keep_if_best();
        }
    }

    /// Whether this set can still grow as large as the best.
    fn can_improve(&self) -> bool {
        let most = self.n_paired + self.open.len() - self.chosen.len();
        (most, -self.joint.nis()) > (self.best_score.0, -self.best_score.1)
    }

    fn keep_if_best(&mut self) {
        let nis = self.joint.nis();
        if (self.n_paired, -nis) > (self.best_score.0, -self.best_score.1) {
            self.best_score = (self.n_paired, nis);
            self.best.fill(None);
            for ((observation, _), chosen) in self.open.iter().zip(&self.chosen) {
                self.best[*observation] = chosen.map(|candidate| candidate.prediction);
            }
        }
    }

    /// Pairs the next open observation with a candidate, or with none; `false` if that is incompatible with the pairings so far.
    fn step_down(&mut self, candidate: Option<&'a Candidate<M>>) -> bool {
        if let Some(candidate) = candidate {
            self.trials_left -= 1;
            let is_free = self.chosen.iter().flatten().all(|other| other.prediction != candidate.prediction);
            if !is_free || !self.join(candidate) {
                return false;
            }
            self.n_paired += 1;
        }
        self.chosen.push(candidate);
        true
    }

    fn step_back(&mut self) {
        if let Some(Some(_)) = self.chosen.pop() {
            self.n_paired -= 1;
            self.joint.truncate(self.n_paired * MeasurementDim::<M>::DIM);
        }
    }

    /// Adds a pairing to the joint innovation, if they are jointly compatible.
    fn join(&mut self, candidate: &Candidate<M>) -> bool {
        let before = self.joint.dimension();
        let own = &self.predictions[candidate.prediction];
        let paired = self.chosen.iter().flatten();
        let blocks: Vec<_> = paired
            .map(|other| {
                let common = self.filter.model().common_noise(&candidate.measurement, &other.measurement);
                self.filter.predicted_cross_covariance(own, &self.predictions[other.prediction]) + common
            })
            .collect();
        let size = MeasurementDim::<M>::DIM;
        for row in 0..size {
            let with_others =
                blocks.iter().flat_map(|block| block.row(row).iter().copied().collect::<Vec<_>>());
            let with_own = (0..=row).map(|column| candidate.innovation.covariance[(row, column)]);
            if self.joint.push(with_others.chain(with_own), candidate.innovation.residual[row]).is_none() {
                self.joint.truncate(before);
                return false;
            }
        }
        let gate = self.gates.get(before + size - 1).copied().unwrap_or(0.0);
        let fits = self.joint.nis() <= gate;
        if !fits {
            self.joint.truncate(before);
        }
        fits
    }
}
