use wayfix_estimation_traits::LogWeight;

use crate::ParticleError;

/// Weights that are not negative, finite, and add up to one: what a [`Resampler`](crate::Resampler) draws by.
///
/// ```
/// use wayfix_particle::NormalizedWeights;
/// let weights = NormalizedWeights::from_log(&[-1000.0, -1000.0, f64::NEG_INFINITY])?; // far below the smallest f64, still half and half
/// assert_eq!(weights.as_slice(), [0.5, 0.5, 0.0]);
/// assert_eq!(weights.effective_sample_size(), 2.0);
/// # Ok::<(), wayfix_particle::ParticleError>(())
/// ```
#[derive(Clone, Debug, PartialEq)]
pub struct NormalizedWeights(Vec<f64>);

impl NormalizedWeights {
    /// $`w_i ∝ e^{l_i}`$ from log weights in nats.
    ///
    /// # Errors
    /// [`ParticleError::LogWeight`] for NaN and positive infinity, [`ParticleError::NoWeight`] when all are $`-∞`$,
    /// [`ParticleError::NoParticles`] for an empty list.
    pub fn from_log(log_weights: &[LogWeight]) -> Result<Self, ParticleError> {
        let mut weights = Self::placeholder();
        weights.assign_log(log_weights)?;
        Ok(weights)
    }

    /// Plain weights, scaled to add up to one.
    ///
    /// # Errors
    /// [`ParticleError::Weight`] for one that is negative or not finite, [`ParticleError::NoWeight`] when all are zero,
    /// [`ParticleError::NoParticles`] for an empty list.
    pub fn from_linear(mut weights: Vec<f64>) -> Result<Self, ParticleError> {
        if let Some(index) = weights.iter().position(|weight| !(*weight >= 0.0 && weight.is_finite())) {
            return Err(ParticleError::Weight { index, value: weights[index] });
        }
        let largest = weights.iter().copied().fold(0.0, f64::max);
        check_some_weight(weights.len(), largest > 0.0)?;
        // By the largest first: the sum of huge weights would overflow.
        weights.iter_mut().for_each(|weight| *weight /= largest);
        normalize(&mut weights);
        Ok(Self(weights))
    }

    /// No weights at all, which only [`assign_log`](Self::assign_log) may meet.
    pub(crate) fn placeholder() -> Self {
        Self(vec![])
    }

    /// [`from_log`](Self::from_log) into memory that is there already; $`\log \sum_i e^{l_i}`$.
    pub(crate) fn assign_log(&mut self, log_weights: &[LogWeight]) -> Result<f64, ParticleError> {
        check_log_weights(log_weights)?;
        let largest = log_weights.iter().copied().fold(f64::NEG_INFINITY, f64::max);
        check_some_weight(log_weights.len(), largest > f64::NEG_INFINITY)?;
        self.0.clear();
        self.0.extend(log_weights.iter().map(|l| (l - largest).exp()));
        Ok(largest + normalize(&mut self.0).ln())
    }

    /// The weights, in the order of the particles.
    pub fn as_slice(&self) -> &[f64] {
        &self.0
    }

    /// $`1 / \sum_i w_i^2`$: how many equally weighted particles would estimate as well, between 1 and their number.
    /// [Kong, Liu & Wong 1994]
    pub fn effective_sample_size(&self) -> f64 {
        1.0 / self.0.iter().map(|weight| weight * weight).sum::<f64>()
    }

    /// The last particle that is possible at all, where rounding must not let a walk run past it.
    pub(crate) fn last_positive(&self) -> usize {
        self.0.iter().rposition(|weight| *weight > 0.0).unwrap_or(0)
    }
}

/// The first log weight that is NaN or positive infinity.
pub(crate) fn check_log_weights(log_weights: &[LogWeight]) -> Result<(), ParticleError> {
    match log_weights.iter().position(|l| l.is_nan() || *l == f64::INFINITY) {
        Some(index) => Err(ParticleError::LogWeight { index, value: log_weights[index] }),
        None => Ok(()),
    }
}

fn check_some_weight(count: usize, some: bool) -> Result<(), ParticleError> {
    match count {
        0 => Err(ParticleError::NoParticles),
        _ if !some => Err(ParticleError::NoWeight { count }),
        _ => Ok(()),
    }
}

/// Divides by the sum and returns it; one weight at least is 1.
fn normalize(weights: &mut [f64]) -> f64 {
    let sum: f64 = weights.iter().sum();
    weights.iter_mut().for_each(|weight| *weight /= sum);
    sum
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn bad_weights_are_refused_with_their_index() {
        let no_weight = ParticleError::NoWeight { count: 2 };
        assert_eq!(NormalizedWeights::from_linear(vec![]), Err(ParticleError::NoParticles));
        assert_eq!(NormalizedWeights::from_log(&[]), Err(ParticleError::NoParticles));
        assert_eq!(NormalizedWeights::from_linear(vec![0.0, 0.0]), Err(no_weight.clone()));
        assert_eq!(NormalizedWeights::from_log(&[f64::NEG_INFINITY; 2]), Err(no_weight));
        for bad in [-1.0, f64::INFINITY] {
            let refused = NormalizedWeights::from_linear(vec![1.0, bad]);
            assert_eq!(refused, Err(ParticleError::Weight { index: 1, value: bad }));
        }
        assert!(NormalizedWeights::from_linear(vec![1.0, f64::NAN]).is_err());
        assert!(NormalizedWeights::from_log(&[0.0, f64::NAN]).is_err());
        assert_eq!(
            NormalizedWeights::from_log(&[0.0, f64::INFINITY]),
            Err(ParticleError::LogWeight { index: 1, value: f64::INFINITY })
        );
    }

    #[test]
    fn weights_of_any_size_add_up_to_one() {
        for scale in [1e-320, 1e-300, 1.0, 1e300, f64::MAX / 4.0] {
            let weights = NormalizedWeights::from_linear(vec![scale, 2.0 * scale, scale]).unwrap();
            // A subnormal scale has few bits of its own: 1e-320 is good to 2e-4 only; but doubling is exact.
            assert_eq!(weights.as_slice(), [0.25, 0.5, 0.25]);
        }
    }
}
