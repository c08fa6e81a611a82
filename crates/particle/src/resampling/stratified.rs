use rand::Rng;

use super::{
    Resampler,
    walk::{open_closed, walk},
};
use crate::Weights;

/// One random point in each of $`n`$ equal strata. [Kitagawa 1996]
///
/// ```
/// use rand::SeedableRng;
/// use wayfix_particle::{Resampler, Stratified, Weights};
/// let weights = Weights::from_linear(vec![1.0, 1.0])?;
/// let mut rng = rand_chacha::ChaCha8Rng::seed_from_u64(7);
/// assert_eq!(Stratified.ancestors(&weights, 4, &mut rng)?, [0, 0, 1, 1]);
/// # Ok::<(), wayfix_particle::ParticleError>(())
/// ```
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct Stratified;

impl Resampler for Stratified {
    fn fill<R: Rng + ?Sized>(&self, weights: &Weights, ancestors: &mut [usize], rng: &mut R) {
        let n = ancestors.len();
        walk(weights, (0..n).map(|stratum| (stratum as f64 + open_closed(rng)) / n as f64), ancestors);
    }
}
