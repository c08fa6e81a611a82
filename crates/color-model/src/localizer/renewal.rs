use std::collections::BTreeSet;

use nalgebra::Vector3;
use rand::{Rng, RngExt};
use wayfix_estimation_traits::{Manifold, Pose2};
use wayfix_particle::{RaoBlackwell, Resampler, Systematic, Weights};

use super::{
    LocalizerParams,
    particle::{CameraLocation, ColorParticle},
    relight::Relight,
    start::Area,
};
use crate::ColorModelError;

/// How one generation of particles follows another: resampling, as many as needed, and newcomers when the robot may have been carried away.
pub(crate) struct Renewal<'a> {
    pub(crate) params: &'a LocalizerParams,
    pub(crate) area: &'a Area,
    /// Of having been carried away, 0 to 1.
    pub(crate) suspicion: f64,
    /// Where the robot seems to be.
    pub(crate) estimate: &'a Pose2<f64>,
}

/// What all newcomers of a frame weigh together: little, so that they take over only where they explain frames much better. At equal weight
/// a softened likelihood would let the mass of them win by number.
const NEWCOMERS_WEIGHT: f64 = 0.01;

/// The next generation.
pub(crate) struct Renewed {
    pub(crate) particles: Vec<ColorParticle>,
    pub(crate) weights: Weights,
    pub(crate) n_injected: usize,
}

impl Renewal<'_> {
    pub(crate) fn renew<R: Rng + ?Sized>(
        &self,
        particles: &[ColorParticle],
        weights: &Weights,
        relight: &Relight,
        rng: &mut R,
    ) -> Result<Renewed, ColorModelError> {
        let share = self.suspicion.clamp(self.params.min_injected, self.params.max_injected);
        let n_wanted = self.n_wanted(particles, weights, rng)?;
        let n_injected = (share * n_wanted as f64) as usize;
        let is_poor = weights.effective_sample_size() < self.params.resample_below * particles.len() as f64;
        if self.suspicion == 0.0 && !is_poor && particles.len() <= 2 * n_wanted {
            let all: Vec<usize> = (0..particles.len()).collect();
            let particles = relight.descendants(particles, &all);
            return Ok(Renewed { particles, weights: weights.clone(), n_injected: 0 });
        }
        let ancestors = Systematic.ancestors(weights, n_wanted - n_injected, rng)?;
        let mut renewed = relight.descendants(particles, &ancestors);
        for _ in 0..n_injected {
            let light = renewed[rng.random_range(0..ancestors.len())].shared_conditional().clone();
            let (body, error) = (self.newcomer(rng), self.params.camera.sample(rng));
            renewed.push(RaoBlackwell::from_shared(CameraLocation { body, error }, light));
        }
        let each = NEWCOMERS_WEIGHT / n_injected.max(1) as f64;
        let mut weights = vec![(1.0 - NEWCOMERS_WEIGHT) / ancestors.len() as f64; ancestors.len()];
        weights.resize(renewed.len(), each);
        let weights = Weights::from_linear(weights)?;
        Ok(Renewed { particles: renewed, weights, n_injected })
    }

    /// A pose to try: near the estimate, in case it is a little off, or anywhere, in case the robot was carried away.
    fn newcomer<R: Rng + ?Sized>(&self, rng: &mut R) -> Pose2<f64> {
        let mut pose = self.area.sample(rng);
        if rng.random::<bool>() {
            let mut within = |reach: f64| reach * (2.0 * rng.random::<f64>() - 1.0);
            pose = self.estimate.retract(&Vector3::new(within(0.6), within(0.6), within(0.6)));
            self.area.clamp(&mut pose);
        }
        pose
    }

    /// As many particles as keep the sampling error within its bound, for as many cells as they occupy. [Fox 2003, Eq. 7]
    fn n_wanted<R: Rng + ?Sized>(
        &self,
        particles: &[ColorParticle],
        weights: &Weights,
        rng: &mut R,
    ) -> Result<usize, ColorModelError> {
        let most =
            if self.suspicion > 0.0 { self.params.max_particles_lost } else { self.params.max_particles };
        let drawn = Systematic.ancestors(weights, most, rng)?;
        let cells: BTreeSet<_> = drawn.iter().map(|&at| cell(&particles[at].sampled.body)).collect();
        Ok(kld_bound(cells.len()).clamp(self.params.min_particles, most))
    }
}

fn cell(pose: &Pose2<f64>) -> [i64; 3] {
    [pose.x() / 0.1, pose.y() / 0.1, pose.heading() / 0.1].map(|v| v.floor() as i64)
}

fn kld_bound(k: usize) -> usize {
    let k = (k.max(2) - 1) as f64;
    let a = 2.0 / (9.0 * k);
    (k / (2.0 * 0.05) * (1.0 - a + a.sqrt() * 2.33).powi(3)) as usize
}
