//! The same bits for any number of threads, and for none.
#![allow(clippy::unwrap_used, reason = "a test that cannot build its particles has failed")]

use rand::{Rng, RngExt as _, SeedableRng};
use rand_chacha::ChaCha8Rng;
use wayfix_particle::{ParticleChunkRng, ParticleError, ParticleSet};

const SEED: u64 = 20_261_121;

/// Draws a varying number of random numbers a particle, so that streams that run into each other show.
fn wander(x: &mut f64, rng: &mut ParticleChunkRng) {
    for _ in 0..rng.random_range(1..5) {
        *x += rng.random::<f64>();
    }
}

/// The documented scheme, written down once more: 32 bytes of the caller's generator seed ChaCha8, chunk `k` of 32 particles draws from
/// stream `k`. With and without the feature `parallel` the set has to agree with it.
#[test]
fn each_chunk_of_32_draws_from_its_own_stream() {
    for n in [1, 31, 32, 33, 1000] {
        let mut particles = ParticleSet::new(vec![0.0; n]).unwrap();
        let mut rng = ChaCha8Rng::seed_from_u64(SEED);
        let mut seed = [0; 32];
        rng.clone().fill_bytes(&mut seed);

        particles.propagate(wander, &mut rng);

        let mut expected = vec![0.0; n];
        for (k, chunk) in expected.chunks_mut(32).enumerate() {
            let mut stream = ChaCha8Rng::from_seed(seed);
            stream.set_stream(k as u64);
            chunk.iter_mut().for_each(|x| wander(x, &mut stream));
        }
        assert_eq!(particles.states(), expected);
        let mut used = ChaCha8Rng::seed_from_u64(SEED);
        used.fill_bytes(&mut [0; 32]);
        assert_eq!(rng, used, "the caller's generator gives 32 bytes, whatever the number of particles");
    }
}

#[derive(Debug, PartialEq)]
enum StepError {
    Particle(ParticleError),
    At(f64),
}
impl From<ParticleError> for StepError {
    fn from(error: ParticleError) -> Self {
        Self::Particle(error)
    }
}

/// Of several particles that fail the first is reported, whichever thread comes to it first.
#[test]
fn the_first_failure_is_reported() {
    let states: Vec<f64> = (0..1000).map(f64::from).collect();
    let before = ParticleSet::new(states).unwrap();
    let mut particles = before.clone();
    let step = |(): &mut (), x: &mut f64, _: &mut ParticleChunkRng| {
        *x += 0.25;
        if *x > 300.0 { Err(StepError::At(*x)) } else { Ok(0.0) }
    };
    let failed = particles.advance_with(|| (), step, &mut ChaCha8Rng::seed_from_u64(SEED));
    assert_eq!(failed, Err(StepError::At(300.25)));
    assert_eq!(particles, before);
}

#[cfg(feature = "parallel")]
mod pools {
    use super::*;
    use wayfix_particle::SystematicResampler;

    /// A filter's whole day: prior, motion, likelihood, proposal, resampling to other numbers.
    fn run() -> (Vec<u64>, Vec<u64>) {
        let mut rng = ChaCha8Rng::seed_from_u64(SEED);
        let mut particles = ParticleSet::from_fn(777, |rng| rng.random_range(0.0..10.0), &mut rng).unwrap();
        for step in 0..10 {
            particles.propagate(wander, &mut rng);
            particles.reweigh(|x| -0.5 * (x - f64::from(step)).powi(2)).unwrap();
            let proposal = |(): &mut (), x: &mut f64, rng: &mut ParticleChunkRng| {
                wander(x, rng);
                Ok::<_, ParticleError>(-x.abs())
            };
            particles.advance_with(|| (), proposal, &mut rng).unwrap();
            particles.normalize().unwrap();
            particles.resample(&SystematicResampler, 500 + 100 * step as usize, &mut rng).unwrap();
            particles.reweigh(|x| x.sin()).unwrap();
        }
        let bits = |numbers: &[f64]| numbers.iter().map(|x| x.to_bits()).collect();
        (bits(particles.states()), bits(particles.log_weights()))
    }

    #[test]
    fn one_two_and_five_threads_give_the_same_bits() {
        let [one, two, five] = [1, 2, 5].map(|threads| {
            rayon::ThreadPoolBuilder::new().num_threads(threads).build().unwrap().install(run)
        });
        assert_eq!(one, two);
        assert_eq!(one, five);
    }
}
