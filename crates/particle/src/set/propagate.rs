use rand::Rng;

use super::ParticleSet;
use crate::chunks::{CHUNK, ParticleChunkRng, Streams, map_chunks};

impl<X: Send> ParticleSet<X> {
    /// Moves every particle: $`x_i ∼ p(x_k | x_{k-1} = x_i)`$. Weights stay.
    ///
    /// The same bits for any number of threads: particles draw from a stream of their chunk, seeded from `rng`.
    pub fn propagate<R: Rng + ?Sized>(
        &mut self,
        motion: impl Fn(&mut X, &mut ParticleChunkRng) + Sync,
        rng: &mut R,
    ) {
        self.propagate_with(|| (), |(), state, rng| motion(state, rng), rng);
    }

    /// [`propagate`](Self::propagate) with something that `prepare` makes once a chunk of particles: a curried model, working memory.
    ///
    /// What a motion leaves in it must not matter to the next particle.
    pub fn propagate_with<S, R: Rng + ?Sized>(
        &mut self,
        prepare: impl Fn() -> S + Sync,
        motion: impl Fn(&mut S, &mut X, &mut ParticleChunkRng) + Sync,
        rng: &mut R,
    ) {
        self.propagate_chunks(CHUNK, prepare, motion, rng);
    }

    /// [`propagate_with`](Self::propagate_with), each particle a chunk of its own: for a motion of some milliseconds, of which a dozen keep all threads busy.
    pub fn propagate_each<S, R: Rng + ?Sized>(
        &mut self,
        prepare: impl Fn() -> S + Sync,
        motion: impl Fn(&mut S, &mut X, &mut ParticleChunkRng) + Sync,
        rng: &mut R,
    ) {
        self.propagate_chunks(1, prepare, motion, rng);
    }

    fn propagate_chunks<S, R: Rng + ?Sized>(
        &mut self,
        size: usize,
        prepare: impl Fn() -> S + Sync,
        motion: impl Fn(&mut S, &mut X, &mut ParticleChunkRng) + Sync,
        rng: &mut R,
    ) {
        let streams = Streams::from_generator(rng);
        map_chunks(size, &mut self.states, &mut self.log_weights, |chunk, states, _| {
            let (mut prepared, mut rng) = (prepare(), streams.stream(chunk));
            for state in states {
                motion(&mut prepared, state, &mut rng);
            }
        });
    }
}
