use nalgebra::DefaultAllocator;
use rand::Rng;
use wayfix_estimation_traits::{
    BayesFilter, LikelihoodModel, Manifold, Policy as _, SampleMotion, StateAlloc,
};

use super::BootstrapFilter;
use crate::{NormalizationReport, ParticleError, ParticleSet, Systematic, ess_below};

/// A particle filter with its generator: for code that runs any [`BayesFilter`].
///
/// It resamples systematically, to as many particles as there are, when the effective sample size falls below
/// [`resample_below`](Self::resample_below). After an error the generator too is as it was.
#[derive(Clone, Debug, PartialEq)]
pub struct SeededFilter<F, R> {
    /// The filter.
    pub filter: F,
    /// Where its random numbers come from.
    pub rng: R,
    /// Smallest effective share of particles before resampling, in [0, 1].
    pub resample_below: f64,
}

impl<F, R> SeededFilter<F, R> {
    /// A filter that resamples when less than half of its particles count.
    pub fn new(filter: F, rng: R) -> Self {
        Self { filter, rng, resample_below: 0.5 }
    }
}

impl<M, L, R> BayesFilter for SeededFilter<BootstrapFilter<M, L>, R>
where
    M: SampleMotion + Sync,
    M::State: Manifold + Send,
    M::Control: Sync,
    L: LikelihoodModel<State = M::State> + Sync,
    L::Measurement: Sync,
    R: Rng + Clone,
    DefaultAllocator: StateAlloc<<M::State as Manifold>::Dim>,
{
    type Control = M::Control;
    type Measurement = L::Measurement;
    type Estimate = ParticleSet<M::State>;
    type Report = NormalizationReport;
    type Error = ParticleError;

    fn predict(&mut self, control: &M::Control) -> Result<(), ParticleError> {
        let mut rng = self.rng.clone();
        self.filter.predict(control, &mut rng)?;
        self.rng = rng;
        Ok(())
    }

    fn update(&mut self, measurement: &L::Measurement) -> Result<NormalizationReport, ParticleError> {
        let evidence = self.filter.update(measurement)?;
        if ess_below(self.resample_below).fires(&evidence) {
            let particles = self.filter.particles_mut();
            particles.resample(&Systematic, particles.n_particles(), &mut self.rng)?;
        }
        Ok(evidence)
    }

    fn estimate(&self) -> ParticleSet<M::State> {
        self.filter.particles().clone()
    }
}
