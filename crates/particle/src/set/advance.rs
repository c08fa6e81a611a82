use rand::Rng;
use wayfix_estimation_traits::LogWeight;

use super::{ParticleSet, reweigh::add, workspace::Workspace};
use crate::{
    ParticleError,
    chunks::{CHUNK, ParticleChunkRng, Streams, map_chunks},
    memory::{reserve, resize},
};

impl<X: Clone + Send> ParticleSet<X> {
    /// Sequential importance sampling with any proposal: `step` draws the next state in place of the old one and returns its incremental
    /// weight $`\log \frac{p(z | x) \, p(x | x_{k-1})}{q(x | x_{k-1}, z)}`$. [Doucet, Godsill & Andrieu 2000]
    ///
    /// For proposals that use the measurement, and for Rao-Blackwellised particles, whose conditional part is corrected on the way.
    /// `prepare` makes something once a chunk of particles: a curried model, working memory.
    ///
    /// # Errors
    /// The error of the first particle whose step fails; or [`ParticleError::LogWeight`], as for [`reweigh`](Self::reweigh). All particles are
    /// as they were.
    pub fn advance_with<S, E, R>(
        &mut self,
        prepare: impl Fn() -> S + Sync,
        step: impl Fn(&mut S, &mut X, &mut ParticleChunkRng) -> Result<LogWeight, E> + Sync,
        rng: &mut R,
    ) -> Result<(), E>
    where
        E: From<ParticleError> + Send,
        R: Rng + ?Sized,
    {
        let streams = Streams::from_generator(rng);
        let Self { states, log_weights, workspace: Workspace { states: advanced, log_weights: weighed, .. } } =
            self;
        advanced.clear();
        reserve(advanced, states.len())?;
        advanced.extend_from_slice(states);
        resize(weighed, states.len(), 0.0)?;
        let stepped: Result<(), E> = map_chunks(CHUNK, advanced, weighed, |chunk, states, increments| {
            let (mut prepared, mut rng) = (prepare(), streams.stream(chunk));
            for (state, increment) in states.iter_mut().zip(increments) {
                *increment = step(&mut prepared, state, &mut rng)?;
            }
            Ok(())
        })
        .into_iter()
        .collect();
        let outcome = stepped.and_then(|()| Ok(add(log_weights, weighed)?));
        if outcome.is_ok() {
            std::mem::swap(states, advanced);
            std::mem::swap(log_weights, weighed);
        }
        advanced.clear();
        outcome
    }
}
