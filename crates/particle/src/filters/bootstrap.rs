use nalgebra::{ComplexField as _, DefaultAllocator};
use rand::Rng;
use wayfix_estimation_traits::{LikelihoodModel, Manifold, SampleMotion, StateAlloc};

use crate::{NormalizationReport, ParticleChunkRng, ParticleError, ParticleSet};

/// The bootstrap filter (sampling importance resampling): particles are sampled from the motion model and weighted by the likelihood.
/// [Gordon, Salmond & Smith 1993]
///
/// When to resample, how, and to how many particles is said between the steps, on [`particles_mut`](Self::particles_mut).
///
/// ```
/// use nalgebra::Vector1;
/// use rand::{Rng, RngExt, SeedableRng};
/// use wayfix_estimation_traits::{LikelihoodModel, SampleMotion};
/// use wayfix_particle::{BootstrapFilter, ParticleSet, SystematicResampler};
///
/// struct Drive;
/// impl SampleMotion for Drive {
///     type State = Vector1<f64>;
///     type Control = f64;
///     fn sampler<R: Rng + ?Sized>(&self, metres: &f64) -> impl Fn(&Vector1<f64>, &mut R) -> Vector1<f64> {
///         move |x, rng| x.add_scalar(metres + rng.random_range(-0.1..0.1))
///     }
/// }
/// struct Altimeter;
/// impl LikelihoodModel for Altimeter {
///     type State = Vector1<f64>;
///     type Measurement = f64;
///     fn log_likelihood(&self, z: &f64) -> impl Fn(&Vector1<f64>) -> f64 {
///         move |x| -0.5 * ((z - x[0]) / 0.1).powi(2)
///     }
/// }
///
/// let mut rng = rand_chacha::ChaCha8Rng::seed_from_u64(7);
/// let prior = ParticleSet::from_fn(500, |rng| Vector1::new(rng.random_range(-5.0..5.0)), &mut rng)?;
/// let mut filter = BootstrapFilter::new(prior, Drive, Altimeter);
/// for truth in [1.0, 2.0, 3.0] {
///     filter.predict(&1.0, &mut rng)?;
///     if filter.update(&truth)?.effective_share() < 0.5 {
///         filter.particles_mut().resample(&SystematicResampler, 500, &mut rng)?;
///     }
/// }
/// let moments = filter.particles().moments(|x| *x)?;
/// assert!((moments.mean[0] - 3.0).abs() < 0.2);
/// # Ok::<(), wayfix_particle::ParticleError>(())
/// ```
#[derive(Clone, Debug, PartialEq)]
pub struct BootstrapFilter<M: SampleMotion, L> {
    motion: M,
    sensor: L,
    particles: ParticleSet<M::State>,
}

impl<M: SampleMotion, L> BootstrapFilter<M, L> {
    /// A filter that starts from `particles`.
    pub fn new(particles: ParticleSet<M::State>, motion: M, sensor: L) -> Self {
        Self { motion, sensor, particles }
    }
    /// The particles.
    pub fn particles(&self) -> &ParticleSet<M::State> {
        &self.particles
    }
    /// The particles for resampling.
    pub fn particles_mut(&mut self) -> &mut ParticleSet<M::State> {
        &mut self.particles
    }
}

impl<M, L> BootstrapFilter<M, L>
where
    M: SampleMotion + Sync,
    M::State: Manifold + Send,
    M::Control: Sync,
    L: LikelihoodModel<State = M::State> + Sync,
    L::Measurement: Sync,
    DefaultAllocator: StateAlloc<<M::State as Manifold>::Dim>,
{
    /// Moves the particles.
    ///
    /// # Errors
    /// [`ParticleError::State`] with the first particle that would not be finite; the particles are as they were.
    pub fn predict<R: Rng + ?Sized>(
        &mut self,
        control: &M::Control,
        rng: &mut R,
    ) -> Result<(), ParticleError> {
        let mut moved = self.particles.clone();
        let motion = &self.motion;
        moved.propagate_with(
            || motion.sampler::<ParticleChunkRng>(control),
            |draw, state, rng| *state = draw(state, rng),
            rng,
        );
        if let Some(index) = moved.states().iter().position(|state| !is_finite(state)) {
            return Err(ParticleError::State { index });
        }
        self.particles = moved;
        Ok(())
    }

    /// Weighs the particles and normalizes their weights; does not resample.
    ///
    /// # Errors
    /// [`ParticleError::LogWeight`] when a log-likelihood is NaN or positive infinity, [`ParticleError::NoWeight`] when no particle
    /// explains the measurement; the particles are as they were.
    pub fn update(&mut self, measurement: &L::Measurement) -> Result<NormalizationReport, ParticleError> {
        let sensor = &self.sensor;
        self.particles
            .correct_with(|| sensor.log_likelihood(measurement), |likelihood, state| likelihood(state))
    }
}

/// A point that is not finite is not where it is: its distance to itself is NaN.
fn is_finite<X: Manifold>(state: &X) -> bool
where
    DefaultAllocator: StateAlloc<X::Dim>,
{
    state.local(state).iter().all(|coordinate| coordinate.is_finite())
}
