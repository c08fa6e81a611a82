use rand::Rng;

use super::{Multinomial, Resampler};
use crate::Weights;

/// $`⌊n w_i⌋`$ children for certain, the remaining ones drawn by what is left of the weights. [Liu & Chen 1998]
///
/// ```
/// use rand::SeedableRng;
/// use wayfix_particle::{Resampler, Residual, Weights};
/// let weights = Weights::from_linear(vec![1.0, 3.0])?;
/// let mut rng = rand_chacha::ChaCha8Rng::seed_from_u64(7);
/// assert_eq!(Residual.ancestors(&weights, 4, &mut rng)?, [0, 1, 1, 1]);
/// # Ok::<(), wayfix_particle::ParticleError>(())
/// ```
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct Residual;

impl Resampler for Residual {
    fn fill<R: Rng + ?Sized>(&self, weights: &Weights, ancestors: &mut [usize], rng: &mut R) {
        let n = ancestors.len();
        let mut rest = Vec::with_capacity(weights.as_slice().len());
        let mut filled = 0;
        for (index, share) in weights.as_slice().iter().enumerate() {
            let expected = share * n as f64;
            // 49 × (1/49) rounds to just below 1, and its child is certain all the same.
            let certain = ((expected * (1.0 + 4.0 * f64::EPSILON)) as usize).min(n - filled);
            ancestors[filled..filled + certain].fill(index);
            filled += certain;
            rest.push((expected - certain as f64).max(0.0));
        }
        // No rest at all means that every child was certain.
        if let Ok(rest) = Weights::from_linear(rest) {
            Multinomial.fill(&rest, &mut ancestors[filled..], rng);
        }
        ancestors.sort_unstable();
    }
}
