use nalgebra::Vector3;
use rand::Rng;
use wayfix_particle::{ParticleChunkRng, ParticleSet};

use super::{
    acquisition::Effort,
    candidate::Candidate,
    evidence::Scratch,
    hypothesis::is_same_place,
    search::{Search, stride},
    trajectory::Trajectory,
};
use crate::{ColorModelError, PixelSums, PrefixSumImage, likelihood::gather};

/// What a step's length is multiplied by after a success, and after a failure: it stays the same when one in five succeeds [Rechenberg 1973].
const LONGER: f64 = 1.5;
const SHORTER: f64 = 0.9036;

/// A place from which less of the frames shows the map than this share is not looked at more closely: nothing speaks against it, whatever is seen.
const LEAST_IN_VIEW: f64 = 0.1;
/// What puts such a place behind all others, nats.
const BLIND: f64 = 1e6;

/// How candidates come to explain the frames better.
impl Search<'_> {
    /// Does `job` to every candidate, each with a random stream of its chunk's.
    pub(super) fn each<R: Rng + ?Sized>(
        &self,
        candidates: Vec<Candidate>,
        rng: &mut R,
        job: impl Fn(&mut Scratch, &mut Candidate, &mut ParticleChunkRng) + Sync,
    ) -> Result<Vec<Candidate>, ColorModelError> {
        let mut set = ParticleSet::new(candidates)?;
        set.propagate_with(|| Scratch::new(self), job, rng);
        Ok(set.states().to_vec())
    }

    /// Tries steps in a pass, and takes those that explain the frames better: first of the whole trajectory, longer after a success and shorter after a
    /// failure, then, in the later passes, of the odometry and of the camera's error at every frame.
    pub(super) fn refine<R: Rng + ?Sized>(
        &self,
        scratch: &mut Scratch,
        candidate: &mut Candidate,
        pass: u32,
        rng: &mut R,
    ) {
        let acquisition = &self.params.acquisition;
        let effort = acquisition.effort(pass);
        if pass == 0 || effort != acquisition.effort(pass - 1) {
            self.weigh(scratch, candidate, effort);
        }
        for _ in 0..acquisition.n_moves {
            let sigmas =
                Vector3::new(acquisition.reach, acquisition.reach, acquisition.turn) * candidate.step;
            let is_better =
                self.consider(scratch, candidate, candidate.trajectory.moved(&sigmas, rng), effort);
            candidate.step *= if is_better { LONGER } else { SHORTER };
        }
        if acquisition.is_fine(pass) {
            let fresh = acquisition.scale(pass);
            self.consider(scratch, candidate, candidate.trajectory.rewalked(fresh, rng), effort);
            for at in 0..self.shots.len() {
                self.jolt(scratch, candidate, at, fresh, rng);
            }
        }
    }

    /// Takes a trajectory if it is better, and says whether.
    fn consider(
        &self,
        scratch: &mut Scratch,
        candidate: &mut Candidate,
        mut trajectory: Trajectory,
        effort: Effort,
    ) -> bool {
        self.area.clamp(&mut trajectory.newest);
        if candidate.known.is_some_and(|known| !is_same_place(&known.place, &trajectory.newest)) {
            return false;
        }
        let mut moved = Candidate { trajectory, ..candidate.clone() };
        self.weigh(scratch, &mut moved, effort);
        let is_better = moved.score > candidate.score;
        if is_better {
            *candidate = moved;
        }
        is_better
    }

    /// Tries another error of the camera at one frame.
    fn jolt<R: Rng + ?Sized>(
        &self,
        scratch: &mut Scratch,
        candidate: &mut Candidate,
        at: usize,
        fresh: f64,
        rng: &mut R,
    ) {
        let n_colors = self.map.colors().len();
        let trajectory = candidate.trajectory.jolted(at, fresh, rng);
        let mut jolted = Candidate { trajectory, ..candidate.clone() };
        let locations = jolted.trajectory.locations(&self.shots, &self.params.camera);
        let camera_pose = locations[at].camera_pose(&self.shots[at].mount);
        let sums = &mut jolted.sums[at * n_colors..][..n_colors];
        let margin = self.params.acquisition.edge_margin;
        if gather(&mut scratch.projector, |_| Some(&self.frames[at]), &camera_pose, margin, sums).is_ok() {
            jolted.log_prior += jolted.trajectory.log_prior() - candidate.trajectory.log_prior();
            self.weigh_frame(scratch, &mut jolted, at, Effort::Full);
            self.score(scratch, &mut jolted, Effort::Full);
            if jolted.score > candidate.score {
                *candidate = jolted;
            }
        }
    }

    /// Weighs a candidate by all frames or by a few.
    pub(super) fn weigh(&self, scratch: &mut Scratch, candidate: &mut Candidate, effort: Effort) {
        let n_colors = self.map.colors().len();
        let locations = candidate.trajectory.locations(&self.shots, &self.params.camera);
        candidate.log_prior = self.start.log_prior(&locations[0].body) + candidate.trajectory.log_prior();
        let stride = match effort {
            Effort::Coarse => stride(self.shots.len(), self.params.acquisition.n_coarse),
            Effort::Full => 1,
        };
        candidate.sums.fill(PixelSums::default());
        candidate.by_frame.fill(0.0);
        for at in (0..self.shots.len()).rev().step_by(stride) {
            let camera_pose = locations[at].camera_pose(&self.shots[at].mount);
            let sums = &mut candidate.sums[at * n_colors..][..n_colors];
            let margin = self.params.acquisition.edge_margin;
            if gather(&mut scratch.projector, |_| Some(&self.frames[at]), &camera_pose, margin, sums).is_err()
            {
                sums.fill(PixelSums::default());
            }
            self.weigh_frame(scratch, candidate, at, effort);
        }
        self.score(scratch, candidate, effort);
        let n_seen = candidate.sums.iter().map(|sums| sums.count() + sums.n_outliers()).sum::<u64>() as f64;
        let n_pixels =
            self.frames.first().map_or(0, PrefixSumImage::n_pixels) * self.shots.len().div_ceil(stride);
        if effort == Effort::Coarse && candidate.known.is_none() && n_seen < LEAST_IN_VIEW * n_pixels as f64 {
            candidate.score -= BLIND;
        }
    }
}
