use rand::Rng;

use super::{MultinomialResampler, Resampler, spread::expand};
use crate::NormalizedWeights;

/// $`⌊n w_i⌋`$ children for certain, the remaining ones drawn by what is left of the weights. [Liu & Chen 1998]
///
/// ```
/// use rand::SeedableRng;
/// use wayfix_particle::{Resampler, ResidualResampler, NormalizedWeights};
/// let weights = NormalizedWeights::from_linear(vec![1.0, 3.0])?;
/// let mut rng = rand_chacha::ChaCha8Rng::seed_from_u64(7);
/// assert_eq!(ResidualResampler.ancestors(&weights, 4, &mut rng)?, [0, 1, 1, 1]);
/// # Ok::<(), wayfix_particle::ParticleError>(())
/// ```
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct ResidualResampler;

impl Resampler for ResidualResampler {
    fn fill<R: Rng + ?Sized>(&self, weights: &NormalizedWeights, ancestors: &mut [usize], rng: &mut R) {
        let n = ancestors.len();
        let expected = || weights.as_slice().iter().map(|share| share * n as f64);
        // 49 × (1/49) rounds to just below 1, and its child is certain all the same.
        let mut children: Vec<usize> =
            expected().map(|count| (count * (1.0 + 4.0 * f64::EPSILON)) as i64 as usize).collect();
        let rest =
            expected().zip(&children).map(|(count, certain)| (count - *certain as f64).max(0.0)).collect();
        // No rest at all means that every child was certain.
        if let Ok(rest) = NormalizedWeights::from_linear(rest) {
            let drawn = &mut ancestors[..n.saturating_sub(children.iter().sum())];
            MultinomialResampler.fill(&rest, drawn, rng);
            drawn.iter().for_each(|ancestor| children[*ancestor] += 1);
        }
        let mut end = 0;
        let ends = children.iter().map(|count| {
            end += count;
            end
        });
        let filled = expand(ends, ancestors);
        ancestors[filled..].fill(weights.last_positive());
    }
}
