use std::sync::Arc;

use nalgebra::DefaultAllocator;
use wayfix_estimation_traits::{Manifold, MotionModel, SensorModel, StateAlloc, UpdateAlloc};
use wayfix_gaussian_core::Gaussian;

use crate::{Innovation, KalmanAlgorithm, KalmanError, check, error::Checked};

/// A bank of filters for one state under different conditions, of which one is active at a time.
///
/// Only the active filter changes; the others keep their state bit for bit. The caller selects the active one:
/// [`JumpMarkovFilter`](super::JumpMarkovFilter) by the most probable histories, a particle filter by drawing an index for each particle.
/// Clones share the models. [Schulz & Fox 2004, §III.A.3 and §V.B]
///
/// ```
/// use nalgebra::{Matrix1, Vector1};
/// use wayfix_gaussian_core::Gaussian;
/// use wayfix_kalman::{ExtendedKalmanAlgorithm, LinearMotion, LinearSensor, FilterBank};
/// let brightness = |mean: f64| Gaussian::new(Vector1::new(mean), Matrix1::new(100.0));
/// let drift = LinearMotion::stationary(Matrix1::new(1.0))?;
/// let mut bank = FilterBank::new(vec![drift.clone(), drift], ExtendedKalmanAlgorithm, &[brightness(40.0)?, brightness(160.0)?])?;
/// let sensor = LinearSensor::new(Matrix1::new(1.0), Matrix1::new(25.0))?;
/// bank.predict(&None)?;
/// let candidates = bank.candidates(&sensor, &Vector1::new(150.0))?;
/// assert!(candidates[1].innovation.log_likelihood() > candidates[0].innovation.log_likelihood());
/// let bright = candidates.into_iter().nth(1).expect("two models");
/// bank.activate(1, bright.belief);
/// assert_eq!(bank.last_active_estimate(0), Some(brightness(40.0)?)); // the dark one is as it was
/// assert!((bank.last_active_estimate(1).expect("two models").mean()[0] - 152.0).abs() < 0.1);
/// # Ok::<(), wayfix_kalman::KalmanError>(())
/// ```
#[derive(Clone, Debug)]
pub struct FilterBank<M: MotionModel, F: KalmanAlgorithm<M::State>>
where
    DefaultAllocator: StateAlloc<<M::State as Manifold>::Dim>,
{
    models: Arc<[M]>,
    form: F,
    settled: Vec<F::Belief>,
    predicted: Vec<F::Belief>,
}

/// The result of a measurement in one filter of a bank: its innovation `I`, whose likelihood is the evidence for it, and the corrected
/// belief `B`.
#[derive(Clone, Debug)]
pub struct FilterBankUpdate<I, B> {
    /// The innovation under this model.
    pub innovation: I,
    /// The belief after the measurement, if this model is the active one.
    pub belief: B,
}

impl<M: MotionModel, F: KalmanAlgorithm<M::State>> FilterBank<M, F>
where
    DefaultAllocator: StateAlloc<<M::State as Manifold>::Dim>,
{
    /// One filter per model, each with its own prior.
    ///
    /// # Errors
    /// Returns an error if there are no models, their number differs from that of the priors, or a prior is not positive definite.
    pub fn new(models: Vec<M>, form: F, priors: &[Gaussian<M::State>]) -> Result<Self, KalmanError> {
        if models.is_empty() {
            return Err(KalmanError::EmptyBank);
        }
        check::dimension("bank of priors", models.len(), priors.len())?;
        let settled = priors.iter().map(|prior| form.belief_from(prior)).collect::<Checked<Vec<_>>>()?;
        Ok(Self { models: models.into(), form, predicted: settled.clone(), settled })
    }

    /// How many filters.
    pub fn n_models(&self) -> usize {
        self.models.len()
    }

    /// The belief of filter `model` when it was last active; `None` if there is no such filter.
    pub fn last_active_estimate(&self, model: usize) -> Option<Gaussian<M::State>> {
        self.settled.get(model).map(|belief| belief.clone().into())
    }

    /// The belief of filter `model` if it has been active since the last measurement; `None` if there is no such filter.
    pub fn predicted(&self, model: usize) -> Option<Gaussian<M::State>> {
        self.predicted.get(model).map(|belief| belief.clone().into())
    }

    /// Predicts the belief of every filter with `control`, as if it were the active one.
    ///
    /// # Errors
    /// Returns an error if a model output is invalid; the bank is then unchanged.
    pub fn predict(&mut self, control: &M::Control) -> Result<(), KalmanError> {
        let predict = |(belief, model)| self.form.predict(belief, model, control);
        self.predicted =
            self.predicted.iter().zip(self.models.iter()).map(predict).collect::<Checked<Vec<_>>>()?;
        Ok(())
    }

    /// The result of `measurement` in each filter. Changes nothing.
    ///
    /// # Errors
    /// Returns an error if model output or measurement are invalid.
    #[allow(clippy::type_complexity, reason = "the two parts of a candidate")]
    pub fn candidates<S>(
        &self,
        sensor: &S,
        measurement: &S::Measurement,
    ) -> Result<Vec<FilterBankUpdate<Innovation<M::State, S::Measurement>, F::Belief>>, KalmanError>
    where
        S: SensorModel<State = M::State>,
        DefaultAllocator: UpdateAlloc<<M::State as Manifold>::Dim, <S::Measurement as Manifold>::Dim>,
    {
        let candidate = |belief: &F::Belief| {
            let (innovation, posterior) = self.form.update(belief, sensor, measurement, |_| true)?;
            Ok(FilterBankUpdate { innovation, belief: posterior.unwrap_or_else(|| belief.clone()) })
        };
        self.predicted.iter().map(candidate).collect()
    }

    /// Makes filter `model` the active one, with `belief`; the others return to their belief when last active.
    ///
    /// An index beyond the bank activates none.
    pub fn activate(&mut self, model: usize, belief: F::Belief) {
        if let Some(settled) = self.settled.get_mut(model) {
            *settled = belief;
        }
        self.predicted = self.settled.clone();
    }
}
