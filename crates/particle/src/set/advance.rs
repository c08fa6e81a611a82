use rand::Rng;
use wayfix_estimation_traits::LogWeight;

use super::{ParticleSet, reweigh::add};
use crate::{
    ParticleError,
    chunks::{ChunkRng, Streams, map_chunks},
    memory::filled,
};

impl<X: Clone + Send> ParticleSet<X> {
    /// Sequential importance sampling with any proposal: `step` draws the next state in place of the old one and returns its incremental
    /// weight $`\log \frac{p(z | x) \, p(x | x_{k-1})}{q(x | x_{k-1}, z)}`$. [Doucet, Godsill & Andrieu 2000]
    ///
    /// For proposals that look at the measurement, and for Rao-Blackwellised particles, whose conditional part is corrected on the way.
    /// `prepare` makes something once a chunk of particles: a curried model, working memory.
    ///
    /// # Errors
    /// The error of the first particle whose step fails; or [`ParticleError::LogWeight`], as for [`reweigh`](Self::reweigh). All particles are
    /// as they were.
    pub fn advance_with<S, E, R>(
        &mut self,
        prepare: impl Fn() -> S + Sync,
        step: impl Fn(&mut S, &mut X, &mut ChunkRng) -> Result<LogWeight, E> + Sync,
        rng: &mut R,
    ) -> Result<(), E>
    where
        E: From<ParticleError> + Send,
        R: Rng + ?Sized,
    {
        let mut increments = filled(self.n_particles(), 0.0)?;
        let mut states = self.states.clone();
        let streams = Streams::from_generator(rng);
        map_chunks(&mut states, &mut increments, |chunk, states, increments| {
            let (mut prepared, mut rng) = (prepare(), streams.stream(chunk));
            for (state, increment) in states.iter_mut().zip(increments) {
                *increment = step(&mut prepared, state, &mut rng)?;
            }
            Ok(())
        })
        .into_iter()
        .collect::<Result<(), E>>()?;
        add(&self.log_weights, &mut increments)?;
        self.log_weights = increments;
        self.states = states;
        Ok(())
    }
}
