use nalgebra::DefaultAllocator;
use rand::Rng;
use wayfix_estimation_traits::{LikelihoodModel, Manifold, MotionModel, SampleMotion, StateAlloc};
use wayfix_gaussian_core::GaussianMotionSampler;

use crate::{NormalizationReport, ParticleChunkRng, ParticleError, ParticleSet, SystematicResampler};

/// The auxiliary particle filter: ancestors are chosen by the likelihood of the new measurement at their predicted state.
/// [Pitt & Shephard 1999]
///
/// The predicted state is $`f(x, u)`$ of the motion model, the mean of its Gaussian noise.
/// Better than the bootstrap filter where the measurement is sharp and the motion is not much blurred; worse where the predicted state says
/// little about the actual one.
///
/// ```
/// use nalgebra::{Matrix1, Vector1};
/// use rand::{RngExt, SeedableRng};
/// use wayfix_estimation_traits::{LikelihoodModel, MotionModel};
/// use wayfix_particle::{AuxiliaryFilter, ParticleSet};
///
/// struct Drift;
/// impl MotionModel for Drift {
///     type State = Vector1<f64>;
///     type Control = ();
///     fn propagate(&self, x: &Vector1<f64>, _: &()) -> Vector1<f64> {
///         *x
///     }
///     fn noise(&self, _: &Vector1<f64>, _: &()) -> Matrix1<f64> {
///         Matrix1::new(0.03 * 0.03)
///     }
/// }
/// struct Ruler;
/// impl LikelihoodModel for Ruler {
///     type State = Vector1<f64>;
///     type Measurement = f64;
///     fn log_likelihood(&self, z: &f64) -> impl Fn(&Vector1<f64>) -> f64 {
///         move |x| -0.5 * ((z - x[0]) / 0.1).powi(2)
///     }
/// }
///
/// let mut rng = rand_chacha::ChaCha8Rng::seed_from_u64(7);
/// let prior = ParticleSet::from_fn(500, |rng| Vector1::new(rng.random_range(-5.0..5.0)), &mut rng)?;
/// let mut filter = AuxiliaryFilter::new(prior, Drift, Ruler);
/// let evidence = filter.step(&(), &2.0, &mut rng)?;
/// assert!(evidence.effective_share() > 0.7); // the bootstrap filter would be left with some 4 %
/// # Ok::<(), wayfix_particle::ParticleError>(())
/// ```
#[derive(Clone, Debug, PartialEq)]
pub struct AuxiliaryFilter<M: MotionModel, L>
where
    DefaultAllocator: StateAlloc<<M::State as Manifold>::Dim>,
{
    motion: GaussianMotionSampler<M>,
    sensor: L,
    particles: ParticleSet<M::State>,
}

impl<M: MotionModel, L> AuxiliaryFilter<M, L>
where
    DefaultAllocator: StateAlloc<<M::State as Manifold>::Dim>,
{
    /// A filter that starts from `particles`.
    pub fn new(particles: ParticleSet<M::State>, motion: M, sensor: L) -> Self {
        Self { motion: GaussianMotionSampler(motion), sensor, particles }
    }
    /// The particles.
    pub fn particles(&self) -> &ParticleSet<M::State> {
        &self.particles
    }
    /// The particles, to replace some or all.
    pub fn particles_mut(&mut self) -> &mut ParticleSet<M::State> {
        &mut self.particles
    }
}

impl<M, L> AuxiliaryFilter<M, L>
where
    M: MotionModel + Sync,
    M::State: Send,
    M::Control: Sync,
    L: LikelihoodModel<State = M::State> + Sync,
    L::Measurement: Sync,
    GaussianMotionSampler<M>: SampleMotion<State = M::State, Control = M::Control>,
    DefaultAllocator: StateAlloc<<M::State as Manifold>::Dim>,
{
    /// Predicts and corrects in one: ancestors by $`w_i \, p(z | μ_i)`$ with $`μ_i`$ their predicted state, then a draw from the motion of each,
    /// weighed by $`p(z | x) / p(z | μ)`$. The evidence is the product of both stages, an unbiased estimate. [Pitt et al. 2012]
    ///
    /// # Errors
    /// [`ParticleError::LogWeight`] when a log-likelihood is NaN or positive infinity; [`ParticleError::NoWeight`] when no predicted state
    /// or no drawn particle explains the measurement. The particles are as they were.
    pub fn step<R: Rng + ?Sized>(
        &mut self,
        control: &M::Control,
        measurement: &L::Measurement,
        rng: &mut R,
    ) -> Result<NormalizationReport, ParticleError> {
        let (motion, sensor) = (&self.motion, &self.sensor);
        let mut candidates = self.candidates()?;
        candidates.propagate_with(
            || sensor.log_likelihood(measurement),
            |log_likelihood, candidate, _| {
                candidate.promise = log_likelihood(&motion.0.propagate(&candidate.state, control));
            },
            rng,
        );
        let first_stage = candidates.correct_with(|| (), |(), candidate| candidate.promise)?;
        candidates.resample(&SystematicResampler, self.particles.n_particles(), rng)?;
        candidates.propagate_with(
            || motion.sampler::<ParticleChunkRng>(control),
            |draw, candidate, rng| candidate.state = draw(&candidate.state, rng),
            rng,
        );
        let second_stage = candidates.correct_with(
            || sensor.log_likelihood(measurement),
            |log_likelihood, candidate| log_likelihood(&candidate.state) - candidate.promise,
        )?;
        let ParticleSet { states, log_weights, .. } = candidates;
        let states = states.into_iter().map(|candidate| candidate.state).collect();
        self.particles = ParticleSet::from_parts(states, log_weights);
        let log_likelihood = first_stage.log_likelihood + second_stage.log_likelihood;
        Ok(NormalizationReport { log_likelihood, ..second_stage })
    }

    fn candidates(&self) -> Result<ParticleSet<Candidate<M::State>>, ParticleError> {
        let candidate = |state: &M::State| Candidate { state: state.clone(), promise: 0.0 };
        let states = self.particles.states().iter().map(candidate).collect();
        ParticleSet::from_log_weights(states, self.particles.log_weights().to_vec())
    }
}

/// A particle on its way through the two stages.
#[derive(Clone)]
struct Candidate<X> {
    state: X,
    /// Log-likelihood of its, or its ancestor's, predicted state.
    promise: f64,
}
