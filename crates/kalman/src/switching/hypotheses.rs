//! Weighted hypotheses about the active model.

use nalgebra::DefaultAllocator;
use wayfix_estimation_traits::{LogWeight, Manifold, StateAlloc};
use wayfix_gaussian_core::{Gaussian, moment_matched};

use crate::{KalmanError, error::Checked};

/// A belief under the assumption that `model` is active, and its probability.
#[derive(Clone, Debug)]
pub(super) struct Hypothesis<B> {
    pub(super) model: usize,
    pub(super) belief: B,
    pub(super) probability: f64,
}

/// Multiplies each probability by its likelihood and normalizes, in logarithms.
pub(super) fn reweigh<B>(hypotheses: &mut [Hypothesis<B>], log_likelihoods: &[LogWeight]) -> Checked {
    let logs: Vec<f64> = hypotheses
        .iter()
        .zip(log_likelihoods)
        .map(|(hypothesis, log)| hypothesis.probability.ln() + log)
        .collect();
    for (hypothesis, probability) in hypotheses.iter_mut().zip(normalized(&logs)?) {
        hypothesis.probability = probability;
    }
    Ok(())
}

/// Probabilities from unnormalized logarithms.
pub(super) fn normalized(logs: &[LogWeight]) -> Checked<Vec<f64>> {
    let largest = logs.iter().copied().fold(f64::NEG_INFINITY, f64::max);
    if !largest.is_finite() {
        return Err(KalmanError::AllModelsImpossible);
    }
    let sum: f64 = logs.iter().map(|log| (log - largest).exp()).sum();
    Ok(logs.iter().map(|log| (log - largest).exp() / sum).collect())
}

/// The probability of each model.
pub(super) fn model_probabilities<B>(hypotheses: &[Hypothesis<B>], n_models: usize) -> Vec<f64> {
    let mut probabilities = vec![0.0; n_models];
    for hypothesis in hypotheses {
        probabilities[hypothesis.model] += hypothesis.probability;
    }
    probabilities
}

/// The one Gaussian with the moments of the weighted ones.
pub(super) fn merged<'a, X, B>(weighted: impl Iterator<Item = (f64, &'a B)>) -> Checked<Gaussian<X>>
where
    X: Manifold,
    B: Clone + Into<Gaussian<X>> + 'a,
    DefaultAllocator: StateAlloc<X::Dim>,
{
    // A hypothesis of zero weight must not affect the mean, even if it is far away.
    let (weights, components): (Vec<f64>, Vec<_>) = weighted
        .filter(|(weight, _)| *weight > 0.0)
        .map(|(weight, belief)| (weight, belief.clone().into()))
        .unzip();
    Ok(moment_matched(&weights, &components)?)
}
