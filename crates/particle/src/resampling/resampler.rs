use rand::Rng;

use crate::{NormalizedWeights, ParticleError, memory::filled};

/// Draws ancestors for the next generation of particles.
///
/// **Laws**, for $`n`$ ancestors drawn by weights $`w`$:
/// 1. unbiased: the expected number of children of particle $`i`$ is $`n w_i`$,
/// 2. a particle without weight has no children,
/// 3. ancestors come in ascending order (neighbours stay neighbours in memory), and the same generator gives the same ancestors.
///
/// | scheme | variance of the number of children |
/// | --- | --- |
/// | [`SystematicResampler`](crate::SystematicResampler) | smallest: it is $`⌊n w_i⌋`$ or $`⌈n w_i⌉`$. The usual choice |
/// | [`StratifiedResampler`](crate::StratifiedResampler) | never above multinomial; less than 2 away from $`n w_i`$ |
/// | [`ResidualResampler`](crate::ResidualResampler) | never above multinomial; at least $`⌊n w_i⌋`$ |
/// | [`MultinomialResampler`](crate::MultinomialResampler) | $`n w_i (1 - w_i)`$: independent draws, for what needs them |
///
/// [Douc, Cappé & Moulines 2005]
pub trait Resampler {
    /// Fills `ancestors` with indices into `weights`, as many as it is long.
    fn fill<R: Rng + ?Sized>(&self, weights: &NormalizedWeights, ancestors: &mut [usize], rng: &mut R);

    /// `n` ancestors in a list of their own.
    ///
    /// # Errors
    /// [`ParticleError::TooMany`] when they do not fit into memory.
    fn ancestors<R: Rng + ?Sized>(
        &self,
        weights: &NormalizedWeights,
        n: usize,
        rng: &mut R,
    ) -> Result<Vec<usize>, ParticleError> {
        let mut ancestors = filled(n, 0)?;
        self.fill(weights, &mut ancestors, rng);
        Ok(ancestors)
    }
}
