//! Resampling, in nanoseconds a particle: `cargo bench -p wayfix-particle`.
//!
//! Prints `bench<TAB>job<TAB>program<TAB>nanoseconds`, and on the error stream what it takes to copy the weights to the ancestors, 8 bytes in
//! and 8 bytes out: nothing that has to look at every weight and write every ancestor is faster.

use std::hint::black_box;

use rand::{RngExt as _, SeedableRng};
use rand_chacha::ChaCha8Rng;
use wayfix_estimation_traits::Pose2;
use wayfix_particle::{
    MultinomialResampler, NormalizedWeights, ParticleSet, Resampler, ResidualResampler, StratifiedResampler,
    SystematicResampler,
};

const N: usize = 100_000;

fn main() {
    let mut rng = ChaCha8Rng::seed_from_u64(20_261_121);
    // Spread evenly over ± 3 sigma of the likelihood, so that about six in ten particles have children.
    let log_weights: Vec<f64> = (0..N).map(|_| -0.5 * rng.random_range(-3.0_f64..3.0).powi(2)).collect();
    let weights = NormalizedWeights::from_log(&log_weights).expect("finite log weights");

    let mut copied = vec![0.0; N];
    let copy = per_particle(|| black_box(&mut copied).copy_from_slice(black_box(weights.as_slice())));
    eprintln!("copying weights to ancestors: {copy:.2} ns a particle");
    time("resample systematic 1e5", &SystematicResampler, &weights, copy);
    time("resample stratified 1e5", &StratifiedResampler, &weights, copy);
    time("resample residual 1e5", &ResidualResampler, &weights, copy);
    time("resample multinomial 1e5", &MultinomialResampler, &weights, copy);

    time_a_step(&mut rng);
}

/// Weighs, normalizes and resamples the same set again and again, as a filter does. Moving the particles is not timed.
fn time_a_step(rng: &mut ChaCha8Rng) {
    let prior = |rng: &mut ChaCha8Rng| Pose2::new(rng.random_range(-3.0_f64..3.0), 0.0, 0.0);
    let mut particles = ParticleSet::from_fn(N, prior, rng).expect("some particles");
    let mut best = f64::INFINITY;
    for _ in 0..50 {
        particles.propagate(|x, rng| *x = prior(rng), rng);
        let took = seconds(|| {
            particles.reweigh(|x| -0.5 * x.x().powi(2)).expect("finite log-likelihoods");
            particles.normalize().expect("some weight");
            particles.resample(&SystematicResampler, N, rng).expect("some weight").len()
        });
        best = best.min(took);
    }
    println!("bench\treweigh, normalize, resample poses 1e5\twayfix\t{:.2}", best * 1e9 / N as f64);
}

fn time(job: &str, resampler: &impl Resampler, weights: &NormalizedWeights, copy: f64) {
    let mut rng = ChaCha8Rng::seed_from_u64(1);
    let mut ancestors = vec![0; N];
    let took = per_particle(|| resampler.fill(weights, black_box(&mut ancestors), &mut rng));
    println!("bench\t{job}\twayfix\t{took:.2}");
    eprintln!("{job}: {:.1} times a copy", took / copy);
}

/// Nanoseconds: the best of many calls, since other load only ever adds.
fn per_particle<O>(mut job: impl FnMut() -> O) -> f64 {
    let best = (0..50).map(|_| seconds(&mut job)).fold(f64::INFINITY, f64::min);
    best * 1e9 / N as f64
}

fn seconds<O>(job: impl FnOnce() -> O) -> f64 {
    #[allow(clippy::disallowed_methods, reason = "a benchmark measures time")]
    let start = std::time::Instant::now();
    black_box(job());
    start.elapsed().as_secs_f64()
}
