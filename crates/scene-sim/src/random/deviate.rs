//! Random deviates with a fixed number of draws each, bit for bit the same everywhere.
//!
//! `rand_distr` calls the platform's `exp` and `ln` as soon as any crate of the build turns on the `std` feature of
//! `num-traits` (nalgebra does), and its rejection methods take a varying number of draws.

use std::f64::consts::TAU;

use rand::Rng;

/// A number in [0, 1): the top 53 bits of one draw.
pub fn unit<R: Rng + ?Sized>(rng: &mut R) -> f64 {
    (rng.next_u64() >> 11) as f64 * (1.0 / (1u64 << 53) as f64)
}

/// A number in [`low`, `high`).
pub fn uniform<R: Rng + ?Sized>(low: f64, high: f64, rng: &mut R) -> f64 {
    low + (high - low) * unit(rng)
}

/// True with probability `share`; one draw.
pub fn chance<R: Rng + ?Sized>(share: f64, rng: &mut R) -> bool {
    unit(rng) < share
}

/// A whole number below `n` (0 when `n` is 0); one draw.
pub fn below<R: Rng + ?Sized>(n: usize, rng: &mut R) -> usize {
    ((unit(rng) * n as f64) as usize).min(n.saturating_sub(1))
}

/// Mean 0, variance 1; two draws. [Box & Muller 1958]
///
/// ```
/// use rand_chacha::{ChaCha8Rng, rand_core::SeedableRng};
/// use wayfix_scene_sim::random::deviate;
/// let mut rng = ChaCha8Rng::seed_from_u64(7);
/// let mean = (0..10_000).map(|_| deviate::normal(&mut rng)).sum::<f64>() / 10_000.0;
/// assert!(mean.abs() < 0.04); // 4σ of the mean
/// ```
pub fn normal<R: Rng + ?Sized>(rng: &mut R) -> f64 {
    let (radius, angle) = (not_zero(rng), unit(rng));
    (-2.0 * libm::log(radius)).sqrt() * libm::cos(TAU * angle)
}

/// Mean 0, variance 1, nearly Gaussian, never beyond ±√12; one draw and no transcendental function, for noise by the hundred thousand.
///
/// The sum of four uniform numbers (Irwin-Hall): 16 bits each.
pub fn quick_normal<R: Rng + ?Sized>(rng: &mut R) -> f64 {
    let bits = rng.next_u64();
    let sum = (bits & 0xffff) + (bits >> 16 & 0xffff) + (bits >> 32 & 0xffff) + (bits >> 48);
    // Four numbers of variance (2³² − 1)/12 about 65535/2 each.
    (sum as f64 - 131_070.0) * (3.0_f64.sqrt() / 65_536.0)
}

/// A count with the given mean, at most 1000; one draw, by inversion.
pub fn poisson<R: Rng + ?Sized>(mean: f64, rng: &mut R) -> usize {
    let mut left = unit(rng);
    let mut probability = libm::exp(-mean);
    let mut count = 0;
    while left >= probability && count < 1000 {
        left -= probability;
        count += 1;
        probability *= mean / count as f64;
    }
    count
}

/// A number in (0, 1].
pub(super) fn not_zero<R: Rng + ?Sized>(rng: &mut R) -> f64 {
    1.0 - unit(rng)
}
