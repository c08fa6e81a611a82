//! Weighted hypotheses about the active model.

use nalgebra::DefaultAllocator;
use wayfix_estimation_traits::{LogWeight, Manifold, MotionModel, SensorModel, StateAlloc, UpdateAlloc};
use wayfix_gaussian_core::{Gaussian, moment_matched};

use super::MarkovChain;
use crate::{Innovation, KalmanAlgorithm, KalmanError, check, error::Checked};

/// Models, the chain of switches between them, and hypotheses about which of them is active.
#[derive(Clone, Debug)]
pub(super) struct SwitchingBelief<M, F, B> {
    pub(super) models: Vec<M>,
    pub(super) chain: MarkovChain,
    pub(super) form: F,
    pub(super) hypotheses: Vec<Hypothesis<B>>,
}

impl<M: MotionModel, F: KalmanAlgorithm<M::State>> SwitchingBelief<M, F, F::Belief>
where
    DefaultAllocator: StateAlloc<<M::State as Manifold>::Dim>,
{
    /// One hypothesis per model, all with the belief `prior`.
    pub(super) fn new(
        models: Vec<M>,
        chain: MarkovChain,
        form: F,
        prior: &Gaussian<M::State>,
    ) -> Checked<Self> {
        check::dimension("bank of models", chain.n_models(), models.len())?;
        let belief = form.belief_from(prior)?;
        let hypothesis = |(model, &probability)| Hypothesis { model, belief: belief.clone(), probability };
        let hypotheses = chain.initial().iter().enumerate().map(hypothesis).collect();
        Ok(Self { models, chain, form, hypotheses })
    }

    /// The probability of each model.
    pub(super) fn model_probabilities(&self) -> Vec<f64> {
        model_probabilities(&self.hypotheses, self.models.len())
    }

    /// The one Gaussian with the moments of all hypotheses.
    pub(super) fn merged(&self) -> Checked<Gaussian<M::State>> {
        merged(self.hypotheses.iter().map(|h| (h.probability, &h.belief)))
    }

    /// Every hypothesis corrected and weighted by `measurement`.
    #[allow(clippy::type_complexity, reason = "innovations and the hypotheses they correct, one each")]
    pub(super) fn updated<S>(
        &self,
        sensor: &S,
        measurement: &S::Measurement,
    ) -> Checked<(Vec<Innovation<M::State, S::Measurement>>, Vec<Hypothesis<F::Belief>>)>
    where
        S: SensorModel<State = M::State>,
        DefaultAllocator: UpdateAlloc<<M::State as Manifold>::Dim, <S::Measurement as Manifold>::Dim>,
    {
        let mut innovations = Vec::with_capacity(self.hypotheses.len());
        let mut corrected = self.hypotheses.clone();
        for hypothesis in &mut corrected {
            let (innovation, belief) = self.form.update(&hypothesis.belief, sensor, measurement, |_| true)?;
            if let Some(belief) = belief {
                hypothesis.belief = belief;
            }
            innovations.push(innovation);
        }
        let log_likelihoods: Vec<f64> = innovations.iter().map(Innovation::log_likelihood).collect();
        reweigh(&mut corrected, &log_likelihoods)?;
        Ok((innovations, corrected))
    }
}

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
