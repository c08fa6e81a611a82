use std::sync::Arc;

use nalgebra::Vector3;
use wayfix_color_map::{ColorMap, MapRenderer, PinholeCamera};
use wayfix_estimation_traits::Pose3;

use super::{
    particle::ColorParticle,
    threads::for_each,
    views::{ViewMut, Views},
};
use crate::{
    LightErrorCorrelation, PixelLikelihoodParams, PrefixSumImage,
    likelihood::{JointLikelihood, gather, log_likelihood, log_within},
};

/// Particles that one thread weighs with one projector: small enough to share out evenly, large enough to hide the cost of a task.
const CHUNK: usize = 32;

/// What one thread works with.
struct Scratch {
    projector: MapRenderer,
    joint: JointLikelihood,
}

/// Everything that weighing needs besides the particles.
pub(crate) struct Weighing<'a> {
    pub(crate) map: &'a Arc<ColorMap>,
    pub(crate) camera: PinholeCamera,
    /// For each colour.
    pub(crate) frames: &'a [PrefixSumImage],
    pub(crate) mount: &'a Pose3<f64>,
    pub(crate) pixels: &'a PixelLikelihoodParams,
    /// Variance of a map colour's pixels in this frame.
    pub(crate) noise: Vector3<f64>,
}

impl Weighing<'_> {
    /// $`p(z_k | x_k^{(i)}, \bar θ_k^{(i)})`$ of every particle under every member of its lighting bank, all banks of one shape.
    /// [Schulz & Fox 2004, Eq. 16]
    pub(crate) fn views(&self, particles: &[ColorParticle]) -> Option<Views> {
        let mut views = Views::new(particles.len(), &particles.first()?.conditional().bank);
        let scratch = || Scratch {
            projector: MapRenderer::new(Arc::clone(self.map), self.camera),
            joint: JointLikelihood::new(),
        };
        let jobs = particles.chunks(CHUNK).zip(views.chunks_mut(CHUNK));
        for_each(jobs, scratch, |scratch, (particles, views)| {
            particles.iter().zip(views).for_each(|(particle, view)| self.view(scratch, particle, view));
        });
        Some(views)
    }

    fn view(&self, Scratch { projector, joint }: &mut Scratch, particle: &ColorParticle, view: ViewMut) {
        let ViewMut { sums, log_likelihoods } = view;
        let camera_pose = particle.sampled.camera_pose(self.mount);
        let seen = gather(
            projector,
            |color| self.frames.get(color.index()),
            &camera_pose,
            self.pixels.edge_margin_pixels,
            sums,
        )
        .is_ok();
        let light = particle.conditional();
        let n_pixels = self.frames.first().map_or(1, PrefixSumImage::n_pixels);
        let possible = |value: f64| if seen && !value.is_nan() { value } else { f64::NEG_INFINITY };
        let members = log_likelihoods.iter_mut().enumerate();
        match self.pixels.light_error_correlation {
            LightErrorCorrelation::Common => {
                let within = log_within(sums, self.pixels, &self.noise, n_pixels);
                for (at, log_likelihood) in members {
                    let filter = light.bank.member(at);
                    *log_likelihood = possible(
                        within + joint.log_innovation(sums, filter, self.pixels, &self.noise, n_pixels),
                    );
                }
            }
            LightErrorCorrelation::Each => {
                for (at, value) in members {
                    *value = possible(log_likelihood(sums, light.member(at), self.pixels, n_pixels));
                }
            }
        }
    }
}
