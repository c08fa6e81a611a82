//! The law suite of [`Resampler`]: run it on your own schemes.

use rand::Rng;

pub use wayfix_estimation_traits::laws::LawViolation;
use wayfix_estimation_traits::laws::within;

use crate::{NormalizedWeights, Resampler};

/// Standard errors that an average may be off: one in 1.7 million averages of a correct model is further out.
const STANDARD_ERRORS: f64 = 5.0;

/// The laws of [`Resampler`], on `repeats` draws (some 10 000) of `n` ancestors.
///
/// Law 1 by the mean number of children, with the standard error that the draws themselves show. It is at least that of
/// a count that is off by one once in `repeats` draws.
///
/// ```
/// use rand::SeedableRng;
/// use wayfix_particle::{StratifiedResampler, NormalizedWeights, laws};
/// let weights = NormalizedWeights::from_linear(vec![0.1, 0.0, 2.0, 0.7])?;
/// let mut rng = rand_chacha::ChaCha8Rng::seed_from_u64(7);
/// laws::resampler(&StratifiedResampler, &weights, 5, 10_000, &mut rng)?;
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
///
/// # Errors
/// The first law that does not hold.
pub fn resampler<S: Resampler, R: Rng + Clone>(
    resampler: &S,
    weights: &NormalizedWeights,
    n: usize,
    repeats: usize,
    rng: &mut R,
) -> Result<(), LawViolation> {
    let shares = weights.as_slice();
    let (mut sums, mut squares) = (vec![0.0; shares.len()], vec![0.0; shares.len()]);
    let (mut ancestors, mut again) = (vec![0; n], vec![0; n]);
    for repeat in 0..repeats {
        resampler.fill(weights, &mut again, &mut rng.clone());
        resampler.fill(weights, &mut ancestors, rng);
        let case = || format!("draw {repeat}: {ancestors:?}");
        holds("the same generator gives the same ancestors (law 3)", ancestors == again, case)?;
        holds("ancestors ascend (law 3)", ancestors.is_sorted(), case)?;
        let possible = ancestors.iter().all(|i| shares.get(*i).is_some_and(|share| *share > 0.0));
        holds("a particle without weight has no children (law 2)", possible, case)?;
        for (children, i) in ancestors.chunk_by(|a, b| a == b).map(|family| (family.len() as f64, family[0]))
        {
            sums[i] += children;
            squares[i] += children * children;
        }
    }
    let repeats = repeats as f64;
    for (i, share) in shares.iter().enumerate() {
        let (mean, expected) = (sums[i] / repeats, share * n as f64);
        let variance = (squares[i] / repeats - mean * mean).max(1.0 / repeats);
        let case = || format!("particle {i}: {mean} children, expected {expected}");
        let tolerance = STANDARD_ERRORS * (variance / repeats).sqrt();
        within("unbiased (law 1)", (mean - expected).abs(), tolerance, case)?;
    }
    Ok(())
}

fn holds(law: &'static str, condition: bool, case: impl FnOnce() -> String) -> Result<(), LawViolation> {
    within(law, if condition { 0.0 } else { 1.0 }, 0.0, case)
}
