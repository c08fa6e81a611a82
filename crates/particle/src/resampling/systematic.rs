use rand::{Rng, RngExt as _};

use super::{Resampler, spread::spread};
use crate::NormalizedWeights;

/// One random offset for a comb of $`n`$ equidistant points: the number of children is $`⌊n w_i⌋`$ or $`⌈n w_i⌉`$. [Kitagawa 1996]
///
/// ```
/// use rand::SeedableRng;
/// use wayfix_particle::{Resampler, SystematicResampler, NormalizedWeights};
/// let weights = NormalizedWeights::from_linear(vec![1.0, 0.0, 3.0])?;
/// let mut rng = rand_chacha::ChaCha8Rng::seed_from_u64(7);
/// assert_eq!(SystematicResampler.ancestors(&weights, 4, &mut rng)?, [0, 2, 2, 2]); // n w_i is whole, so nothing is left to chance
/// # Ok::<(), wayfix_particle::ParticleError>(())
/// ```
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct SystematicResampler;

impl Resampler for SystematicResampler {
    /// The comb is at $`(i + 1 - v)/n`$, so that $`⌊n C + v⌋`$ of its points lie up to the cumulative weight $`C`$.
    fn fill<R: Rng + ?Sized>(&self, weights: &NormalizedWeights, ancestors: &mut [usize], rng: &mut R) {
        let offset: f64 = rng.random();
        // Through i64, since the processor has no instruction for u64.
        spread(weights, |scaled| (scaled + offset) as i64 as usize, ancestors);
    }
}
