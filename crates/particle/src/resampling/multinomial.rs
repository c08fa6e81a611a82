use rand::Rng;

use super::{
    Resampler,
    walk::{open_closed, walk},
};
use crate::NormalizedWeights;

/// $`n`$ independent draws by weight, in ascending order. [Gordon, Salmond & Smith 1993]
///
/// ```
/// use rand::SeedableRng;
/// use wayfix_particle::{MultinomialResampler, Resampler, NormalizedWeights};
/// let weights = NormalizedWeights::from_linear(vec![0.0, 1.0])?;
/// let mut rng = rand_chacha::ChaCha8Rng::seed_from_u64(7);
/// assert_eq!(MultinomialResampler.ancestors(&weights, 3, &mut rng)?, [1, 1, 1]);
/// # Ok::<(), wayfix_particle::ParticleError>(())
/// ```
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct MultinomialResampler;

impl Resampler for MultinomialResampler {
    /// Sums of $`n + 1`$ exponential gaps over their total are $`n`$ sorted uniform numbers. [Devroye 1986, Ch. V.3]
    fn fill<R: Rng + ?Sized>(&self, weights: &NormalizedWeights, ancestors: &mut [usize], rng: &mut R) {
        let mut sum = 0.0;
        let mut gap = || {
            sum -= open_closed(rng).ln();
            sum
        };
        let points: Vec<f64> = (0..ancestors.len()).map(|_| gap()).collect();
        let total = gap();
        walk(weights, points.iter().map(|point| point / total), ancestors);
    }
}
