use std::sync::Arc;

use nalgebra::Vector3;
use rand::Rng;
use wayfix_color_map::Projector;
use wayfix_particle::{ChunkRng, ParticleSet};

use super::{candidate::Candidate, search::Search};
use crate::{
    ColorModelError, Frame, PixelSums,
    likelihood::{JointLikelihood, gather},
};

/// What one thread works with.
pub(super) struct Scratch {
    projector: Projector,
    joint: JointLikelihood,
    totals: Vec<PixelSums>,
}

/// How well candidates explain the frames, and how they do so better.
impl Search<'_> {
    /// Does `job` to every candidate, each with a random stream of its chunk's.
    pub(super) fn each<R: Rng + ?Sized>(
        &self,
        candidates: Vec<Candidate>,
        rng: &mut R,
        job: impl Fn(&mut Scratch, &mut Candidate, &mut ChunkRng) + Sync,
    ) -> Result<Vec<Candidate>, ColorModelError> {
        let mut set = ParticleSet::new(candidates)?;
        let scratch = || Scratch {
            projector: Projector::new(Arc::clone(self.map), self.camera),
            joint: JointLikelihood::new(),
            totals: vec![PixelSums::default(); self.map.colors().len()],
        };
        set.propagate_with(scratch, job, rng);
        Ok(set.states().to_vec())
    }

    /// Tries steps, and takes those that explain the frames better.
    pub(super) fn refine<R: Rng + ?Sized>(
        &self,
        scratch: &mut Scratch,
        candidate: &mut Candidate,
        scale: f64,
        rng: &mut R,
    ) {
        let acquisition = &self.params.acquisition;
        let n_colors = self.map.colors().len();
        let sigmas = Vector3::new(acquisition.reach, acquisition.reach, acquisition.turn) * scale;
        let mut trajectory = candidate.trajectory.moved(&sigmas, scale, rng);
        self.area.clamp(&mut trajectory.newest);
        let mut moved = Candidate { trajectory, ..candidate.clone() };
        self.weigh(scratch, &mut moved, self.shots.len());
        if moved.score > candidate.score {
            *candidate = moved;
        }
        for at in 0..self.shots.len() {
            let trajectory = candidate.trajectory.jolted(at, scale, rng);
            let mut jolted = Candidate { trajectory, ..candidate.clone() };
            let locations = jolted.trajectory.locations(&self.shots, &self.params.camera);
            let camera_pose = locations[at].camera_pose(&self.shots[at].mount);
            let sums = &mut jolted.sums[at * n_colors..][..n_colors];
            let margin = self.params.acquisition.edge_margin;
            if gather(&mut scratch.projector, |_| Some(&self.frames[at]), &camera_pose, margin, sums).is_ok()
            {
                self.score(scratch, &mut jolted);
                if jolted.score > candidate.score {
                    *candidate = jolted;
                }
            }
        }
    }

    /// Weighs a candidate by `n_shots` of the frames.
    pub(super) fn weigh(&self, scratch: &mut Scratch, candidate: &mut Candidate, n_shots: usize) {
        let n_colors = self.map.colors().len();
        let locations = candidate.trajectory.locations(&self.shots, &self.params.camera);
        let stride = self.shots.len().div_ceil(n_shots.max(1)).max(1);
        candidate.sums.fill(PixelSums::default());
        for at in (0..self.shots.len()).rev().step_by(stride) {
            let camera_pose = locations[at].camera_pose(&self.shots[at].mount);
            let sums = &mut candidate.sums[at * n_colors..][..n_colors];
            let margin = self.params.acquisition.edge_margin;
            if gather(&mut scratch.projector, |_| Some(&self.frames[at]), &camera_pose, margin, sums).is_err()
            {
                sums.fill(PixelSums::default());
            }
        }
        self.score(scratch, candidate);
    }

    /// $`\ln \int \prod_k p(z_k | x_k, θ)\, p(θ)\, dθ`$: the sums of all frames as if they were of one.
    fn score(&self, scratch: &mut Scratch, candidate: &mut Candidate) {
        let Scratch { joint, totals, .. } = scratch;
        candidate.total(totals.len(), totals);
        let n_pixels = self.frames.first().map_or(1, Frame::n_pixels);
        for (member, log_likelihood) in candidate.log_likelihoods.iter_mut().enumerate() {
            let filter = self.light.bank.member(member);
            let value = joint.log_likelihood(totals, filter, &self.params.pixels, &self.noise, n_pixels);
            *log_likelihood = if value.is_nan() { f64::NEG_INFINITY } else { value };
        }
        let best = candidate.log_likelihoods.iter().copied().fold(f64::NEG_INFINITY, f64::max);
        candidate.score = best + candidate.trajectory.log_prior();
    }
}
