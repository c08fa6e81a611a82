use wayfix_estimation_traits::LogWeight;

use crate::discrete::chunks::{CHUNK, fold_chunks, map_chunks};
use crate::discrete::lattice::n_cells;
use crate::error::{check_size, check_state, probability};
use crate::{CondensationError, MeasurementEvidence, MeasurementOutcome, TransitionModel};

/// Where a sum of weights is so small that terms may have been lost below the smallest double: then the sum is done again in logarithms.
const UNDERFLOW: f64 = 1e-250;

/// The state with the largest belief, and that belief.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct MostProbableState {
    /// Its number; the lowest of several that are equal.
    pub state: usize,
    /// The probability that it is the true one, by the filter.
    pub confidence: f64,
}

/// A Bayes filter over a finite set of states: state condensation. [Kasprzak & Szynkiewicz, Eqs. 1–6, Fig. 1]
///
/// Belief is kept as probabilities, measurements come as log-likelihoods, and the product is scaled by the best of them before it leaves
/// the logarithm; if that underflows (the measurement supports states that the belief all but excludes) it is done in logarithms
/// throughout. So the speed is that of the linear form, and nothing representable is lost.
///
/// ```
/// use wayfix_condensation::{DiscreteFilter, PositionGrid, GridMove, MeasurementOutcome, SlipProbabilities};
/// let grid = PositionGrid::new(3, 1)?;
/// let right = SlipProbabilities::default().transition(&grid, GridMove { dx: 1, dy: 0 })?;
/// let mut filter = DiscreteFilter::uniform(3)?;
/// filter.predict(&right)?;
/// let outcome = filter.update(&[-3.0, 0.0, -3.0])?;
/// assert!(matches!(outcome, MeasurementOutcome::Updated(_)));
/// assert_eq!(filter.best().state, 1);
/// assert!(filter.update(&[f64::NAN, 0.0, 0.0]).is_err());
/// # Ok::<(), wayfix_condensation::CondensationError>(())
/// ```
#[derive(Clone, Debug, PartialEq)]
pub struct DiscreteFilter {
    belief: Vec<f64>,
    next: Vec<f64>,
}

impl DiscreteFilter {
    /// Nothing known: the same belief everywhere.
    ///
    /// # Errors
    /// [`CondensationError::Extent`] without states.
    pub fn uniform(n_states: usize) -> Result<Self, CondensationError> {
        n_cells("belief", &[n_states])?;
        Ok(Self { belief: vec![1.0 / n_states as f64; n_states], next: vec![0.0; n_states] })
    }

    /// From weights of what is known before the first measurement, which are normalized. [Kasprzak & Szynkiewicz, Eq. 2]
    ///
    /// # Errors
    /// [`CondensationError::NotFinite`], [`CondensationError::Parameter`] for negative ones, [`CondensationError::ZeroBelief`],
    /// [`CondensationError::Extent`] without states.
    pub fn from_prior(mut weights: Vec<f64>) -> Result<Self, CondensationError> {
        n_cells("belief", &[weights.len()])?;
        for (index, &value) in weights.iter().enumerate() {
            if !value.is_finite() {
                return Err(CondensationError::NotFinite { what: "prior", index, value });
            }
            crate::error::checked("prior weight", value, value >= 0.0, "not negative")?;
        }
        let largest = weights.iter().copied().fold(0.0, f64::max);
        if largest == 0.0 {
            return Err(CondensationError::ZeroBelief);
        }
        weights.iter_mut().for_each(|weight| *weight /= largest);
        let sum: f64 = weights.iter().sum();
        weights.iter_mut().for_each(|weight| *weight /= sum);
        Ok(Self { next: vec![0.0; weights.len()], belief: weights })
    }

    /// Belief of the next step: a transition or a diffusion kernel. [Kasprzak & Szynkiewicz, Eqs. 4–5]
    ///
    /// # Errors
    /// [`CondensationError::Dimension`] when the transition is of another space.
    pub fn predict<T: TransitionModel + ?Sized>(&mut self, transition: &T) -> Result<(), CondensationError> {
        check_size("transition", self.belief.len(), transition.n_states())?;
        transition.predict(&self.belief, &mut self.next);
        std::mem::swap(&mut self.belief, &mut self.next);
        Ok(())
    }

    /// Replaces a share of the belief by the uniform distribution, for a kidnapping or a wrong model.
    ///
    /// # Errors
    /// [`CondensationError::Parameter`] when `share` is no probability.
    pub fn leak(&mut self, share: f64) -> Result<(), CondensationError> {
        let share = probability("share that leaks", share)?;
        let each = share / self.belief.len() as f64;
        map_chunks(&mut self.belief, CHUNK, |_, chunk| {
            chunk.iter_mut().for_each(|p| *p = *p * (1.0 - share) + each);
        });
        Ok(())
    }

    /// Posterior given $`\log p(m \mid s)`$ of every state, in nats up to a common constant. [Kasprzak & Szynkiewicz, Eq. 6]
    ///
    /// # Errors
    /// [`CondensationError::Dimension`], or [`CondensationError::NotFinite`] for NaN and +∞ (−∞ means impossible); the belief is as it was.
    pub fn update(&mut self, log_likelihoods: &[LogWeight]) -> Result<MeasurementOutcome, CondensationError> {
        check_size("list of log-likelihoods", self.belief.len(), log_likelihoods.len())?;
        let best = max_checked(log_likelihoods)?;
        if best == f64::NEG_INFINITY {
            return Ok(MeasurementOutcome::Impossible);
        }
        let (expected, anywhere) = self.weigh(log_likelihoods, best);
        let log_uniform = best + (anywhere / self.belief.len() as f64).ln();
        if expected > UNDERFLOW {
            self.accept(1.0 / expected);
            return Ok(MeasurementOutcome::Updated(MeasurementEvidence {
                log_predicted: best + expected.ln(),
                log_uniform,
            }));
        }
        let Some(log_predicted) = self.weigh_in_logarithms(log_likelihoods) else {
            return Ok(MeasurementOutcome::Impossible);
        };
        Ok(MeasurementOutcome::Updated(MeasurementEvidence { log_predicted, log_uniform }))
    }

    /// The belief, one probability a state.
    pub fn belief(&self) -> &[f64] {
        &self.belief
    }

    /// The state with the largest belief.
    pub fn best(&self) -> MostProbableState {
        let in_chunks = fold_chunks(&self.belief, |first, chunk| {
            let mut best = MostProbableState { state: first, confidence: chunk[0] };
            for (i, &confidence) in chunk.iter().enumerate() {
                if confidence > best.confidence {
                    best = MostProbableState { state: first + i, confidence };
                }
            }
            best
        });
        let first = MostProbableState { state: 0, confidence: f64::NEG_INFINITY };
        in_chunks
            .into_iter()
            .fold(first, |best, next| if next.confidence > best.confidence { next } else { best })
    }

    /// $`-\sum_s b(s) \log b(s)`$, in nats: 0 when certain, $`\log n`$ when nothing is known.
    pub fn entropy(&self) -> f64 {
        fold_chunks(&self.belief, |_, chunk| entropy(chunk)).into_iter().sum()
    }

    /// The belief that the robot is in `state`.
    ///
    /// # Errors
    /// [`CondensationError::State`] when there is no such state.
    pub fn confidence(&self, state: usize) -> Result<f64, CondensationError> {
        check_state(state, self.belief.len())?;
        Ok(self.belief[state])
    }

    /// Writes $`b(s)\, e^{l(s) - \text{best}}`$ into `next`; the sums with and without $`b`$.
    fn weigh(&mut self, log_likelihoods: &[LogWeight], best: f64) -> (f64, f64) {
        let belief = &self.belief;
        let sums = map_chunks(&mut self.next, CHUNK, |first, chunk| {
            let end = first + chunk.len();
            let (mut expected, mut anywhere) = (0.0, 0.0);
            for ((to, p), l) in chunk.iter_mut().zip(&belief[first..end]).zip(&log_likelihoods[first..end]) {
                let likelihood = (l - best).exp();
                *to = p * likelihood;
                expected += *to;
                anywhere += likelihood;
            }
            (expected, anywhere)
        });
        sums.into_iter().fold((0.0, 0.0), |(a, b), (x, y)| (a + x, b + y))
    }

    /// The same product where it underflows; the log evidence, unless nothing is possible.
    fn weigh_in_logarithms(&mut self, log_likelihoods: &[LogWeight]) -> Option<f64> {
        let log_weights = || self.belief.iter().zip(log_likelihoods).map(|(p, l)| p.ln() + l);
        let best = log_weights().fold(f64::NEG_INFINITY, f64::max);
        if best == f64::NEG_INFINITY {
            return None;
        }
        let weights: Vec<f64> = log_weights().map(|log_weight| (log_weight - best).exp()).collect();
        let sum: f64 = weights.iter().sum();
        self.next = weights;
        self.accept(1.0 / sum);
        Some(best + sum.ln())
    }

    /// Makes `next`, scaled, the belief.
    fn accept(&mut self, scale: f64) {
        map_chunks(&mut self.next, CHUNK, |_, chunk| chunk.iter_mut().for_each(|p| *p *= scale));
        std::mem::swap(&mut self.belief, &mut self.next);
    }
}

/// The largest of the values, if none is NaN or +∞.
fn max_checked(log_likelihoods: &[LogWeight]) -> Result<f64, CondensationError> {
    let in_chunks = fold_chunks(log_likelihoods, |first, chunk| {
        let mut best = f64::NEG_INFINITY;
        for (i, &value) in chunk.iter().enumerate() {
            if value.is_nan() || value == f64::INFINITY {
                return Err(CondensationError::NotFinite { what: "log-likelihood", index: first + i, value });
            }
            best = best.max(value);
        }
        Ok(best)
    });
    in_chunks.into_iter().try_fold(f64::NEG_INFINITY, |best, chunk| Ok(best.max(chunk?)))
}

/// Entropy of (a part of) a distribution, in nats.
pub(crate) fn entropy(probabilities: &[f64]) -> f64 {
    -probabilities.iter().filter(|&&p| p > 0.0).map(|p| p * p.ln()).sum::<f64>()
}
