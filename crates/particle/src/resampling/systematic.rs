use rand::{Rng, RngExt as _};

use super::Resampler;
use crate::Weights;

/// One random offset for a comb of $`n`$ equidistant points: the number of children is $`⌊n w_i⌋`$ or $`⌈n w_i⌉`$. [Kitagawa 1996]
///
/// ```
/// use rand::SeedableRng;
/// use wayfix_particle::{Resampler, Systematic, Weights};
/// let weights = Weights::from_linear(vec![1.0, 0.0, 3.0])?;
/// let mut rng = rand_chacha::ChaCha8Rng::seed_from_u64(7);
/// assert_eq!(Systematic.ancestors(&weights, 4, &mut rng)?, [0, 2, 2, 2]); // n w_i is whole, so nothing is left to chance
/// # Ok::<(), wayfix_particle::ParticleError>(())
/// ```
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct Systematic;

/// How many children are written without asking whether there are so many. Most particles have fewer, and a wrong guess of the processor
/// about a branch costs more than these writes.
const WRITTEN_BLINDLY: usize = 4;

impl Resampler for Systematic {
    /// The comb is at $`(i + 1 - v)/n`$, so that $`⌊n C_j + v⌋`$ of its points lie up to the cumulative weight $`C_j`$.
    fn fill<R: Rng + ?Sized>(&self, weights: &Weights, ancestors: &mut [usize], rng: &mut R) {
        let offset: f64 = rng.random();
        let n = ancestors.len();
        let (mut cumulative, mut filled) = (0.0, 0);
        for (index, share) in weights.as_slice().iter().enumerate() {
            cumulative += share;
            // Through i64, since the processor has no instruction for u64.
            let end = ((cumulative * n as f64 + offset) as i64 as usize).min(n);
            match ancestors.get_mut(filled..filled + WRITTEN_BLINDLY) {
                Some(few) if end - filled <= WRITTEN_BLINDLY => few.fill(index),
                _ => ancestors[filled..end].fill(index),
            }
            filled = end;
        }
        // The weights add up to one but for rounding, which may leave the last point out.
        ancestors[filled..].fill(weights.last_positive());
    }
}

#[cfg(test)]
mod tests {
    use super::super::walk::walk;
    use super::*;
    use rand::SeedableRng;
    use rand_chacha::ChaCha8Rng;

    #[test]
    fn the_fast_loop_agrees_with_the_walk() {
        let mut rng = ChaCha8Rng::seed_from_u64(20_261_121);
        for (n_weights, n) in [(1, 1), (1, 9), (9, 1), (7, 7), (1000, 1000), (1000, 37), (50, 4000), (3, 0)] {
            for power in [0, 1, 8, 40] {
                let raw = (0..n_weights).map(|_| rng.random::<f64>().powi(power)).collect();
                let weights = Weights::from_linear(raw).unwrap();
                let mut twin = rng.clone();
                let fast = Systematic.ancestors(&weights, n, &mut rng).unwrap();
                let offset: f64 = twin.random();
                let comb = (0..n).map(|i| (i as f64 + 1.0 - offset) / n as f64);
                let mut plain = vec![0; n];
                walk(&weights, comb, &mut plain);
                assert_eq!(fast, plain, "{n} of {n_weights}, power {power}");
            }
        }
    }
}
