use nalgebra::DefaultAllocator;
use wayfix_estimation_traits::{Manifold, MotionModel, SensorModel, StateAlloc, UpdateAlloc};
use wayfix_gaussian_core::Gaussian;

use super::{
    MarkovChain,
    hypotheses::{Hypothesis, SwitchingBelief, merged},
};
use crate::{Innovation, KalmanAlgorithm, KalmanError, error::Checked};

/// The interacting multiple model filter: one belief per model, mixed before every prediction.
///
/// Mix with $`μ_{i|j} ∝ π_{ij} μ_i`$, predict and update each model's belief, weigh by $`μ_j ∝ \bar μ_j N(y_j; 0, S_j)`$.
/// [Blom & Bar-Shalom 1988] Any [`KalmanAlgorithm`] and any manifold; mixing matches moments.
///
/// ```
/// use nalgebra::{Matrix1, Vector1};
/// use wayfix_gaussian_core::Gaussian;
/// use wayfix_kalman::{ExtendedKalmanAlgorithm, ImmFilter, LinearMotion, LinearSensor, MarkovChain};
/// let still = LinearMotion::stationary(Matrix1::new(1e-4))?;
/// let lively = LinearMotion::stationary(Matrix1::new(1.0))?;
/// let prior = Gaussian::new(Vector1::new(0.0), Matrix1::new(0.1))?;
/// let mut filter = ImmFilter::new(vec![still, lively], MarkovChain::sticky(2, 0.95)?, ExtendedKalmanAlgorithm, &prior)?;
/// let sensor = LinearSensor::new(Matrix1::new(1.0), Matrix1::new(0.01))?;
/// for z in [0.0, 1.1, -0.6, 0.8] {
///     filter.predict(&None)?;
///     filter.update(&sensor, &Vector1::new(z))?;
/// }
/// assert!(filter.model_probabilities()[1] > 0.99);
/// # Ok::<(), wayfix_kalman::KalmanError>(())
/// ```
#[derive(Clone, Debug)]
pub struct ImmFilter<M: MotionModel, F: KalmanAlgorithm<M::State>>
where
    DefaultAllocator: StateAlloc<<M::State as Manifold>::Dim>,
{
    belief: SwitchingBelief<M, F, F::Belief>,
}

impl<M: MotionModel, F: KalmanAlgorithm<M::State>> ImmFilter<M, F>
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

    /// Mixes the beliefs and moves each by `control` with its own model.
    ///
    /// # Errors
    /// Returns an error if a model output is invalid; the filter is then unchanged.
    pub fn predict(&mut self, control: &M::Control) -> Result<(), KalmanError> {
        let SwitchingBelief { models, chain, form, .. } = &self.belief;
        let probabilities = chain.predict_probabilities(&self.model_probabilities());
        let predict = |(model, &probability): (usize, &f64)| {
            let mixed = self.mixed_for(model, probability)?;
            let belief = form.predict(&mixed, &models[model], control)?;
            Ok(Hypothesis { model, belief, probability })
        };
        self.belief.hypotheses =
            probabilities.iter().enumerate().map(predict).collect::<Checked<Vec<_>>>()?;
        Ok(())
    }

    /// Corrects every belief by `measurement` and weights the models. Returns one innovation per model.
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
        self.belief.hypotheses = hypotheses;
        Ok(innovations)
    }

    /// The belief model `to` starts from: all beliefs, weighted by the probability of the transition to it.
    fn mixed_for(&self, to: usize, probability: f64) -> Checked<F::Belief> {
        let SwitchingBelief { chain, form, hypotheses, .. } = &self.belief;
        if probability == 0.0 {
            return Ok(hypotheses[to].belief.clone());
        }
        let weighted = hypotheses.iter().map(|h| (h.probability * chain.probability(h.model, to), &h.belief));
        form.belief_from(&merged(weighted)?)
    }
}
