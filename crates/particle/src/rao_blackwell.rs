use std::collections::{BTreeMap, BTreeSet, btree_map::Entry};
use std::sync::Arc;

use rand::Rng;
use wayfix_estimation_traits::LogWeight;

use crate::{ParticleChunkRng, ParticleError, ParticleSet};

/// A particle whose state is sampled in part, $`x`$, and carried in closed form for the rest, $`p(c | x, z)`$. [Doucet et al. 2000]
///
/// The conditional part may be anything that can be cloned: a Kalman filter, a bank of them, a table. It is shared by all descendants until one
/// of them changes it, so resampling copies no filter.
///
/// ```
/// use wayfix_particle::{ParticleSet, RaoBlackwellParticle, SystematicResampler};
/// use rand::SeedableRng;
/// let mut rng = rand_chacha::ChaCha8Rng::seed_from_u64(7);
/// let mut particles = ParticleSet::new(vec![RaoBlackwellParticle::new(0_u8, vec![0.0; 1000])])?;
/// particles.resample(&SystematicResampler, 100, &mut rng)?; // one vector, a hundred owners
/// let [first, second] = &particles.states()[..2] else { unreachable!() };
/// assert!(first.shares_conditional_with(second));
///
/// let mut changed = first.clone();
/// changed.conditional_mut()[0] = 1.0; // now it has its own
/// assert_eq!((changed.conditional()[0], first.conditional()[0]), (1.0, 0.0));
/// # Ok::<(), wayfix_particle::ParticleError>(())
/// ```
#[derive(Debug, PartialEq)]
pub struct RaoBlackwellParticle<X, C> {
    /// The sampled part.
    pub sampled: X,
    conditional: Arc<C>,
}

/// Clones the sampled part; the conditional one is shared.
impl<X: Clone, C> Clone for RaoBlackwellParticle<X, C> {
    fn clone(&self) -> Self {
        Self { sampled: self.sampled.clone(), conditional: Arc::clone(&self.conditional) }
    }
}

impl<X, C> RaoBlackwellParticle<X, C> {
    /// A particle with a conditional part of its own.
    pub fn new(sampled: X, conditional: C) -> Self {
        Self::from_shared(sampled, Arc::new(conditional))
    }
    /// A particle that shares its conditional part from the start, as all do that come from one prior.
    pub fn from_shared(sampled: X, conditional: Arc<C>) -> Self {
        Self { sampled, conditional }
    }
    /// The conditional part.
    pub fn conditional(&self) -> &C {
        &self.conditional
    }
    /// The conditional part with its owners.
    pub fn shared_conditional(&self) -> &Arc<C> {
        &self.conditional
    }
    /// Replaces the conditional part of this particle alone.
    pub fn set_conditional(&mut self, conditional: Arc<C>) {
        self.conditional = conditional;
    }
    /// The conditional part for changing: copied first when others share it.
    pub fn conditional_mut(&mut self) -> &mut C
    where
        C: Clone,
    {
        Arc::make_mut(&mut self.conditional)
    }
    /// Whether both hold the very same conditional part.
    pub fn shares_conditional_with(&self, other: &Self) -> bool {
        Arc::ptr_eq(&self.conditional, &other.conditional)
    }
}

/// Changes conditional parts by what does not depend on the sampled parts, for example by a drift. Particles that share a part are changed once and still
/// share it.
///
/// ```
/// use wayfix_particle::{ParticleSet, RaoBlackwellParticle, map_conditionals};
/// let mut particles = ParticleSet::new(vec![RaoBlackwellParticle::new((), 1.0); 50])?;
/// map_conditionals(particles.states_mut(), |variance| Ok::<_, std::convert::Infallible>(variance + 0.5)).unwrap();
/// assert_eq!((particles.n_conditionals(), *particles.states()[49].conditional()), (1, 1.5));
/// # Ok::<(), wayfix_particle::ParticleError>(())
/// ```
///
/// # Errors
/// The first of `step`; all particles are as they were.
pub fn map_conditionals<X, C, E>(
    particles: &mut [RaoBlackwellParticle<X, C>],
    mut step: impl FnMut(&C) -> Result<C, E>,
) -> Result<(), E> {
    let mut changed = BTreeMap::new();
    for particle in &*particles {
        if let Entry::Vacant(entry) = changed.entry(Arc::as_ptr(&particle.conditional)) {
            entry.insert(Arc::new(step(&particle.conditional)?));
        }
    }
    // No old part is let go before all are replaced: a new one in its place in memory would be taken for it.
    let replaced: Vec<Arc<C>> =
        particles.iter().map(|particle| Arc::clone(&changed[&Arc::as_ptr(&particle.conditional)])).collect();
    for (particle, conditional) in particles.iter_mut().zip(replaced) {
        particle.conditional = conditional;
    }
    Ok(())
}

impl<X: Clone + Send, C: Clone + Send + Sync> ParticleSet<RaoBlackwellParticle<X, C>> {
    /// One Rao-Blackwellised step: `sample` moves the sampled part, `condition` predicts and corrects the conditional part given it, and
    /// returns how likely the measurement was, $`\log p(z_k | x_{1:k}, z_{1:k-1})`$: the particle's weight.
    ///
    /// Short for [`advance_with`](ParticleSet::advance_with), which also takes working memory and other proposals. Until all particles have
    /// succeeded the old conditional parts are kept, so each is copied. Where that is too dear, weigh by
    /// [`reweigh_with`](ParticleSet::reweigh_with) first and change the conditional parts in place by
    /// [`propagate_with`](ParticleSet::propagate_with) after resampling: then only shared ones are.
    ///
    /// # Errors
    /// As [`advance_with`](ParticleSet::advance_with); all particles are as they were.
    pub fn sample_and_condition<E, R>(
        &mut self,
        sample: impl Fn(&X, &mut ParticleChunkRng) -> X + Sync,
        condition: impl Fn(&X, &mut C) -> Result<LogWeight, E> + Sync,
        rng: &mut R,
    ) -> Result<(), E>
    where
        E: From<ParticleError> + Send,
        R: Rng + ?Sized,
    {
        let step = |(): &mut (), particle: &mut RaoBlackwellParticle<X, C>, rng: &mut ParticleChunkRng| {
            particle.sampled = sample(&particle.sampled, rng);
            condition(&particle.sampled, Arc::make_mut(&mut particle.conditional))
        };
        self.advance_with(|| (), step, rng)
    }

    /// How many conditional parts there are in memory; fewer than particles after resampling.
    pub fn n_conditionals(&self) -> usize {
        self.states().iter().map(|particle| Arc::as_ptr(&particle.conditional)).collect::<BTreeSet<_>>().len()
    }
}
