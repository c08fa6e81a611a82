use rand::{Rng, SeedableRng};
use rand_chacha::ChaCha8Rng;

/// The generator that a chunk of particles draws from: portable, so that the same seed gives the same bits on every machine.
pub type ParticleChunkRng = ChaCha8Rng;

/// One stream of random numbers a chunk, all from one seed.
pub(crate) struct Streams(ParticleChunkRng);

impl Streams {
    /// Takes a seed of 32 bytes from `rng`: as much for one particle as for a million, so that later draws of the caller do not depend on
    /// their number.
    pub(crate) fn from_generator<R: Rng + ?Sized>(rng: &mut R) -> Self {
        let mut seed = [0; 32];
        rng.fill_bytes(&mut seed);
        Self(ParticleChunkRng::from_seed(seed))
    }

    /// The stream of chunk `chunk`.
    pub(crate) fn stream(&self, chunk: usize) -> ParticleChunkRng {
        let mut stream = self.0.clone();
        stream.set_stream(chunk as u64);
        stream
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn streams_differ_by_chunk_and_by_seed_and_repeat() {
        let streams = Streams::from_generator(&mut ParticleChunkRng::seed_from_u64(1));
        let again = Streams::from_generator(&mut ParticleChunkRng::seed_from_u64(1));
        let others = Streams::from_generator(&mut ParticleChunkRng::seed_from_u64(2));
        let first = streams.stream(0).next_u64();
        assert_eq!(first, again.stream(0).next_u64());
        assert_ne!(first, streams.stream(1).next_u64());
        assert_ne!(first, others.stream(0).next_u64());
    }
}
