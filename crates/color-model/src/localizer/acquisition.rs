use nalgebra::Vector3;
use rand::{Rng, RngExt};
use rand_distr::StandardNormal;
use wayfix_estimation_traits::{Manifold, Pose2};
use wayfix_particle::{Resampler, Systematic, Weights};

use super::{CameraNoise, particle::ColorParticle, start::Area, weigh::Weighing, weighed::Weighed};
use crate::ColorModelError;

/// How the robot is looked for in the first frames.
///
/// Seen from half a metre off, the likelihood of a frame is a narrow peak far from every particle, and the light is hardly known. So the first
/// frames are gone through several times, softened each time, with resampling and ever smaller steps in between: an annealed particle filter
/// [Deutscher et al. 2000]. It finds modes and is no sample of the posterior, hence only at the start. Until then all particles share one light,
/// the mixture of theirs: a wrong place cannot make the light its own.
#[derive(Clone, Copy, Debug, PartialEq)]
#[cfg_attr(
    feature = "serde",
    derive(serde::Serialize, serde::Deserialize),
    serde(default, deny_unknown_fields)
)]
pub struct AcquisitionParams {
    /// Frames that it takes.
    pub n_frames: usize,
    /// Fewest particles until then.
    pub n_particles: usize,
    /// Passes over each of these frames before the one that counts.
    pub n_passes: u32,
    /// A pass is softened until this share of the particles is effective.
    pub least_effective: f64,
    /// Standard deviation of the steps after the first pass over the first frame, metres. Each pass halves it.
    pub reach: f64,
    /// The same for the heading, radians.
    pub turn: f64,
}

impl Default for AcquisitionParams {
    fn default() -> Self {
        Self { n_frames: 15, n_particles: 3000, n_passes: 4, least_effective: 0.25, reach: 0.15, turn: 0.15 }
    }
}

impl AcquisitionParams {
    pub(crate) fn values(&self) -> [(&'static str, f64); 3] {
        [
            ("least effective share of a pass", self.least_effective),
            ("reach of a pass (m)", self.reach),
            ("turn of a pass (rad)", self.turn),
        ]
    }
}

/// One search through a frame.
pub(crate) struct Search<'a> {
    pub(crate) params: &'a AcquisitionParams,
    pub(crate) weighing: &'a Weighing<'a>,
    pub(crate) camera: &'a CameraNoise,
    pub(crate) area: &'a Area,
    /// Whether nothing has been seen before.
    pub(crate) is_first: bool,
}

impl Search<'_> {
    /// Particles nearer to the peaks of the frame's likelihood, equally weighted.
    pub(crate) fn run<R: Rng + ?Sized>(
        &self,
        particles: Vec<ColorParticle>,
        weights: &Weights,
        rng: &mut R,
    ) -> Result<(Vec<ColorParticle>, Weights), ColorModelError> {
        let (mut particles, mut weights) = (particles, weights.clone());
        for pass in 0..self.params.n_passes {
            let views = self.weighing.views(&particles);
            let weighed = Weighed::new(&particles, &weights, &views, self.params.least_effective, rng)?;
            let ancestors = Systematic.ancestors(&weighed.weights, particles.len(), rng)?;
            // Particles that have seen a frame before are nearer than those that have not.
            let scale = 0.5_f64.powi(pass as i32 + i32::from(!self.is_first));
            particles = ancestors.iter().map(|&at| self.near(&particles[at], scale, rng)).collect();
            weights = Weights::from_linear(vec![1.0; particles.len()])?;
        }
        Ok((particles, weights))
    }

    fn near<R: Rng + ?Sized>(&self, particle: &ColorParticle, scale: f64, rng: &mut R) -> ColorParticle {
        let mut near = particle.clone();
        let sigmas = Vector3::new(self.params.reach, self.params.reach, self.params.turn) * scale;
        let step = sigmas.map(|sigma| sigma * rng.sample::<f64, _>(StandardNormal));
        let mut body: Pose2<f64> = near.sampled.body.retract(&step);
        self.area.clamp(&mut body);
        near.sampled.body = body;
        // The camera's error keeps its distribution: the part that is drawn anew shrinks with the steps.
        let kept = (1.0 - 0.25 * scale * scale).sqrt();
        near.sampled.error = self.camera.mixed(&particle.sampled.error, kept, rng);
        near
    }
}
