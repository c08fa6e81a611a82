use std::sync::Arc;

use wayfix_color_map::{Camera, ColorMap, Projector};
use wayfix_estimation_traits::Pose3;

use super::particle::ColorParticle;
use crate::{
    Frame, PixelLight, PixelParams, PixelSums,
    likelihood::{JointLikelihood, gather, log_likelihood},
};

/// What a frame shows to every particle.
pub(crate) struct Views {
    /// Sums of every colour, particle by particle.
    sums: Vec<PixelSums>,
    /// Log-likelihood under every member of the lighting bank, particle by particle.
    log_likelihoods: Vec<f64>,
    n_colors: usize,
    n_members: usize,
}

impl Views {
    pub(crate) fn sums(&self, particle: usize) -> &[PixelSums] {
        &self.sums[particle * self.n_colors..][..self.n_colors]
    }
    pub(crate) fn n_members(&self) -> usize {
        self.n_members
    }
    pub(crate) fn by_member(&self, particle: usize) -> &[f64] {
        &self.log_likelihoods[particle * self.n_members..][..self.n_members]
    }
}

/// Particles that one thread weighs with one projector: small enough to share out evenly, large enough to hide the cost of a task.
const CHUNK: usize = 32;

/// What one thread works with.
struct Scratch {
    projector: Projector,
    joint: JointLikelihood,
}

/// Everything that weighing needs besides the particles.
pub(crate) struct Weighing<'a> {
    pub(crate) map: &'a Arc<ColorMap>,
    pub(crate) camera: Camera,
    pub(crate) frame: &'a Frame,
    pub(crate) mount: &'a Pose3<f64>,
    pub(crate) pixels: &'a PixelParams,
}

impl Weighing<'_> {
    /// $`p(z_k | x_k^{(i)}, \bar θ_k^{(i)})`$ of every particle under every member of its lighting bank. [Schulz & Fox 2004, Eq. 16]
    pub(crate) fn views(&self, particles: &[ColorParticle]) -> Views {
        let n_colors = self.map.colors().len();
        let n_members = particles.first().map_or(1, |particle| particle.conditional().bank.n_members());
        let mut views = Views {
            sums: vec![PixelSums::default(); particles.len() * n_colors],
            log_likelihoods: vec![0.0; particles.len() * n_members],
            n_colors,
            n_members,
        };
        let chunks = particles
            .chunks(CHUNK)
            .zip(views.sums.chunks_mut(CHUNK * n_colors))
            .zip(views.log_likelihoods.chunks_mut(CHUNK * n_members));
        self.for_each(chunks, |scratch, ((particles, sums), log_likelihoods)| {
            let each =
                particles.iter().zip(sums.chunks_mut(n_colors)).zip(log_likelihoods.chunks_mut(n_members));
            for ((particle, sums), log_likelihoods) in each {
                self.view(scratch, particle, sums, log_likelihoods);
            }
        });
        views
    }

    fn view(
        &self,
        Scratch { projector, joint }: &mut Scratch,
        particle: &ColorParticle,
        sums: &mut [PixelSums],
        log_likelihoods: &mut [f64],
    ) {
        let camera_pose = particle.sampled.camera_pose(self.mount);
        let seen = gather(projector, self.frame, &camera_pose, self.pixels.edge_margin, sums).is_ok();
        for (member, log_likelihood_of) in log_likelihoods.iter_mut().enumerate() {
            let light = particle.conditional();
            let n_pixels = self.frame.n_pixels();
            let value = match self.pixels.light {
                PixelLight::Common => {
                    joint.log_likelihood(sums, light.bank.member(member), self.pixels, n_pixels)
                }
                PixelLight::Each => log_likelihood(sums, light.member(member), self.pixels, n_pixels),
            };
            *log_likelihood_of = if seen && !value.is_nan() { value } else { f64::NEG_INFINITY };
        }
    }

    fn scratch(&self) -> Scratch {
        Scratch {
            projector: Projector::new(Arc::clone(self.map), self.camera),
            joint: JointLikelihood::new(),
        }
    }

    #[cfg(not(feature = "parallel"))]
    fn for_each<J>(&self, jobs: impl Iterator<Item = J>, job: impl Fn(&mut Scratch, J)) {
        let mut scratch = self.scratch();
        jobs.for_each(|each| job(&mut scratch, each));
    }

    /// Chunks write to their own places and nothing is summed across them, so the bits do not depend on the number of threads.
    #[cfg(feature = "parallel")]
    fn for_each<J: Send>(&self, jobs: impl Iterator<Item = J>, job: impl Fn(&mut Scratch, J) + Sync) {
        use rayon::prelude::*;
        let jobs: Vec<J> = jobs.collect();
        jobs.into_par_iter().for_each_init(|| self.scratch(), |scratch, each| job(scratch, each));
    }
}
