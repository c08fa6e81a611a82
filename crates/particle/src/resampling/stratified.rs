use rand::{Rng, RngExt as _};

use super::{Resampler, spread::spread};
use crate::NormalizedWeights;

/// One random point in each of $`n`$ equal strata. [Kitagawa 1996]
///
/// ```
/// use rand::SeedableRng;
/// use wayfix_particle::{Resampler, StratifiedResampler, NormalizedWeights};
/// let weights = NormalizedWeights::from_linear(vec![1.0, 1.0])?;
/// let mut rng = rand_chacha::ChaCha8Rng::seed_from_u64(7);
/// assert_eq!(StratifiedResampler.ancestors(&weights, 4, &mut rng)?, [0, 0, 1, 1]);
/// # Ok::<(), wayfix_particle::ParticleError>(())
/// ```
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct StratifiedResampler;

impl Resampler for StratifiedResampler {
    /// Of the points $`k + 1 - v_k`$ those of all whole strata below $`n C`$ lie up to it, and perhaps the one of its own stratum.
    fn fill<R: Rng + ?Sized>(&self, weights: &NormalizedWeights, ancestors: &mut [usize], rng: &mut R) {
        let offsets: Vec<f64> = ancestors.iter().map(|_| rng.random()).collect();
        let points_up_to = |scaled: f64| {
            let stratum = scaled as i64 as usize;
            let own = offsets.get(stratum).is_some_and(|offset| scaled - stratum as f64 + offset >= 1.0);
            stratum + usize::from(own)
        };
        spread(weights, points_up_to, ancestors);
    }
}
