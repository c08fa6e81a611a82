use nalgebra::DefaultAllocator;
use wayfix_estimation_traits::{Manifold, MotionModel, SensorModel, StateAlloc, UpdateAlloc};
use wayfix_gaussian_core::Gaussian;

use super::{
    MarkovChain,
    hypotheses::{Hypothesis, SwitchingBelief, merged, model_probabilities},
};
use crate::{Innovation, KalmanAlgorithm, KalmanError, error::Checked};

/// The generalized pseudo-Bayesian filter of second order: every pair of last and present model is a hypothesis of its own until after
/// the update, then those with the same present model are merged.
///
/// $`n^2`$ filter steps where [`ImmFilter`](super::ImmFilter) makes $`n`$, for a posterior that is exact one step longer.
/// [Bar-Shalom et al. 2001, §11.6.5] Any [`KalmanAlgorithm`] and any manifold.
///
/// ```
/// use nalgebra::{Matrix1, Vector1};
/// use wayfix_gaussian_core::Gaussian;
/// use wayfix_kalman::{Gpb2Filter, LinearMotion, LinearSensor, MarkovChain, UnscentedKalmanAlgorithm};
/// let models = vec![LinearMotion::stationary(Matrix1::new(1e-4))?, LinearMotion::stationary(Matrix1::new(1.0))?];
/// let prior = Gaussian::new(Vector1::new(0.0), Matrix1::new(0.1))?;
/// let mut filter = Gpb2Filter::new(models, MarkovChain::sticky(2, 0.95)?, UnscentedKalmanAlgorithm::default(), &prior)?;
/// filter.predict(&None)?;
/// let sensor = LinearSensor::new(Matrix1::new(1.0), Matrix1::new(0.01))?;
/// assert_eq!(filter.update(&sensor, &Vector1::new(2.0))?.len(), 4); // one innovation per pair of models
/// assert!(filter.model_probabilities()[1] > 0.9);
/// # Ok::<(), wayfix_kalman::KalmanError>(())
/// ```
#[derive(Clone, Debug)]
pub struct Gpb2Filter<M: MotionModel, F: KalmanAlgorithm<M::State>>
where
    DefaultAllocator: StateAlloc<<M::State as Manifold>::Dim>,
{
    belief: SwitchingBelief<M, F, F::Belief>,
}

impl<M: MotionModel, F: KalmanAlgorithm<M::State>> Gpb2Filter<M, F>
where
    DefaultAllocator: StateAlloc<<M::State as Manifold>::Dim>,
{
    /// A filter over `models`, all starting from `prior`.
    ///
    /// # Errors
    /// Returns an error if the chain is for another number of models or the prior is not positive definite.
    pub fn new(
        models: Vec<M>,
        chain: MarkovChain,
        form: F,
        prior: &Gaussian<M::State>,
    ) -> Result<Self, KalmanError> {
        Ok(Self { belief: SwitchingBelief::new(models, chain, form, prior)? })
    }

    /// The present probability of each model.
    pub fn model_probabilities(&self) -> Vec<f64> {
        self.belief.model_probabilities()
    }

    /// The belief over all models, moment-matched.
    ///
    /// # Errors
    /// Returns an error if the beliefs are spread so far over a manifold that they have no mean.
    pub fn estimate(&self) -> Result<Gaussian<M::State>, KalmanError> {
        self.belief.merged()
    }

    /// Moves the belief of every model by `control` with every model.
    ///
    /// # Errors
    /// Returns an error if a model output is invalid; the filter is then unchanged.
    pub fn predict(&mut self, control: &M::Control) -> Result<(), KalmanError> {
        // Pairs are left from a prediction without a measurement after it.
        let SwitchingBelief { models, chain, form, hypotheses } = &self.belief;
        let mut pairs = Vec::with_capacity(models.len() * models.len());
        for from in self.merged_by_model(hypotheses)? {
            for (model, motion) in models.iter().enumerate() {
                let probability = from.probability * chain.probability(from.model, model);
                if probability > 0.0 {
                    let belief = form.predict(&from.belief, motion, control)?;
                    pairs.push(Hypothesis { model, belief, probability });
                }
            }
        }
        self.belief.hypotheses = pairs;
        Ok(())
    }

    /// Corrects every hypothesis by `measurement`, weights and merges by model. Returns one innovation per hypothesis.
    ///
    /// # Errors
    /// Returns an error if model output or measurement are invalid; the filter is then unchanged.
    #[allow(clippy::type_complexity, reason = "a list of innovations")]
    pub fn update<S>(
        &mut self,
        sensor: &S,
        measurement: &S::Measurement,
    ) -> Result<Vec<Innovation<M::State, S::Measurement>>, KalmanError>
    where
        S: SensorModel<State = M::State>,
        DefaultAllocator: UpdateAlloc<<M::State as Manifold>::Dim, <S::Measurement as Manifold>::Dim>,
    {
        let (innovations, hypotheses) = self.belief.updated(sensor, measurement)?;
        self.belief.hypotheses = self.merged_by_model(&hypotheses)?;
        Ok(innovations)
    }

    /// One hypothesis per model that has any probability left.
    fn merged_by_model(&self, hypotheses: &[Hypothesis<F::Belief>]) -> Checked<Vec<Hypothesis<F::Belief>>> {
        let probabilities = model_probabilities(hypotheses, self.belief.models.len());
        let possible = probabilities.into_iter().enumerate().filter(|(_, probability)| *probability > 0.0);
        let merge = |(model, probability)| {
            let same = hypotheses.iter().filter(|h| h.model == model).map(|h| (h.probability, &h.belief));
            let belief = self.belief.form.belief_from(&merged(same)?)?;
            Ok(Hypothesis { model, belief, probability })
        };
        possible.map(merge).collect()
    }
}
