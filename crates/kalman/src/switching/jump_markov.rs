use nalgebra::DefaultAllocator;
use wayfix_estimation_traits::{LogWeight, Manifold, MotionModel, SensorModel, StateAlloc, UpdateAlloc};
use wayfix_gaussian_core::Gaussian;

use super::{FilterBank, MarkovChain, hypotheses::normalized};
use crate::{KalmanAlgorithm, KalmanError, check, error::Checked};

/// Jump-Markov model selection: a [`FilterBank`] whose active filter follows a Markov chain.
///
/// The posterior over which filter was active when is kept as its most probable histories, each with its own bank; every measurement
/// extends each history by every model and the best [`n_histories`](JumpMarkovFilterParams::n_histories) survive. With one history it selects
/// greedily, with many it is the optimal filter as far as they reach. This is what the particles of [Schulz & Fox 2004, §III.A.3] sample,
/// without the randomness: the number of models is small, so their optimal proposal is enumerated. Between measurements only the chain
/// is propagated.
///
/// ```
/// use nalgebra::{Matrix1, Vector1};
/// use wayfix_gaussian_core::Gaussian;
/// use wayfix_kalman::{ExtendedKalmanAlgorithm, JumpMarkovFilter, JumpMarkovFilterParams, LinearMotion, LinearSensor, MarkovChain, FilterBank};
/// let brightness = |mean: f64| Gaussian::new(Vector1::new(mean), Matrix1::new(100.0));
/// let drift = LinearMotion::stationary(Matrix1::new(1.0))?;
/// let bank = FilterBank::new(vec![drift.clone(), drift], ExtendedKalmanAlgorithm, &[brightness(40.0)?, brightness(160.0)?])?;
/// let mut light = JumpMarkovFilter::new(bank, MarkovChain::sticky(2, 0.95)?, JumpMarkovFilterParams::default())?;
/// let sensor = LinearSensor::new(Matrix1::new(1.0), Matrix1::new(25.0))?;
/// for seen in [Some(152.0), Some(149.0), None, Some(38.0)] {
///     light.predict(&None)?;
///     light.update(&sensor, seen.map(Vector1::new).as_ref())?;
/// }
/// assert_eq!(light.most_probable_history(), [1, 1, 0]); // at the measurements
/// assert_eq!(light.selected(), 0);
/// # Ok::<(), wayfix_kalman::KalmanError>(())
/// ```
#[derive(Clone)]
pub struct JumpMarkovFilter<M: MotionModel, F: KalmanAlgorithm<M::State>>
where
    DefaultAllocator: StateAlloc<<M::State as Manifold>::Dim>,
{
    chain: MarkovChain,
    params: JumpMarkovFilterParams,
    histories: Vec<History<M, F>>,
    log_evidence: Vec<LogWeight>,
}

/// Limits of the histories of a [`JumpMarkovFilter`].
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct JumpMarkovFilterParams {
    /// Histories kept; default 8, 1 selects greedily.
    pub n_histories: usize,
    /// Number of measurements for which a history stores its models; default 256.
    pub n_recorded_models: usize,
}

impl Default for JumpMarkovFilterParams {
    fn default() -> Self {
        Self { n_histories: 8, n_recorded_models: 256 }
    }
}

/// The active models at the measurements so far, and the belief under that assumption.
#[derive(Clone)]
struct History<M: MotionModel, F: KalmanAlgorithm<M::State>>
where
    DefaultAllocator: StateAlloc<<M::State as Manifold>::Dim>,
{
    bank: FilterBank<M, F>,
    /// Which model is active now: certain just after a measurement, then spread by the chain.
    active: Vec<f64>,
    path: Vec<usize>,
    probability: f64,
}

/// A history extended by one model.
struct Extension<B> {
    parent: usize,
    model: usize,
    belief: B,
    log_weight: LogWeight,
}

impl<M: MotionModel + Clone, F: KalmanAlgorithm<M::State> + Clone> JumpMarkovFilter<M, F>
where
    DefaultAllocator: StateAlloc<<M::State as Manifold>::Dim>,
{
    /// Selects among the filters of `bank`.
    ///
    /// # Errors
    /// Returns an error if the chain is for another number of models, or `n_histories` is 0.
    pub fn new(
        bank: FilterBank<M, F>,
        chain: MarkovChain,
        params: JumpMarkovFilterParams,
    ) -> Result<Self, KalmanError> {
        check::dimension("bank of models", chain.n_models(), bank.n_models())?;
        if params.n_histories == 0 {
            return Err(KalmanError::OutOfRange { what: "number of histories", value: 0.0 });
        }
        let log_evidence = vec![0.0; bank.n_models()];
        let history = History { bank, active: chain.initial().to_vec(), path: Vec::new(), probability: 1.0 };
        Ok(Self { chain, params, histories: vec![history], log_evidence })
    }

    /// A time step: propagates the chain and predicts every filter.
    ///
    /// # Errors
    /// Returns an error if a model output is invalid; nothing is then changed.
    pub fn predict(&mut self, control: &M::Control) -> Result<(), KalmanError> {
        let mut histories = self.histories.clone();
        for history in &mut histories {
            history.bank.predict(control)?;
            history.active = self.chain.predict_probabilities(&history.active);
        }
        self.histories = histories;
        Ok(())
    }

    /// Weights the models by `measurement` and corrects the active filter of each surviving history. `None`: no measurement.
    ///
    /// # Errors
    /// Returns an error if model output or measurement are invalid, or no model explains the measurement; nothing is then changed.
    pub fn update<S>(&mut self, sensor: &S, measurement: Option<&S::Measurement>) -> Result<(), KalmanError>
    where
        S: SensorModel<State = M::State>,
        DefaultAllocator: UpdateAlloc<<M::State as Manifold>::Dim, <S::Measurement as Manifold>::Dim>,
    {
        let Some(measurement) = measurement else { return Ok(()) };
        let (mut extensions, log_evidence) = self.extended(sensor, measurement)?;
        // Stable, so that equals keep their order and runs repeat.
        extensions.sort_by(|a, b| b.log_weight.total_cmp(&a.log_weight));
        extensions.truncate(self.params.n_histories);
        let log_weights: Vec<f64> = extensions.iter().map(|extension| extension.log_weight).collect();
        let probabilities = normalized(&log_weights)?;
        self.histories = extensions.into_iter().zip(probabilities).map(|(e, p)| self.grown(e, p)).collect();
        self.log_evidence = log_evidence;
        Ok(())
    }

    /// The present probability of each model.
    pub fn model_probabilities(&self) -> Vec<f64> {
        (0..self.chain.n_models())
            .map(|model| {
                self.histories.iter().map(|history| history.probability * history.active[model]).sum()
            })
            .collect()
    }

    /// The model that is most probably active now.
    pub fn selected(&self) -> usize {
        let probabilities = self.model_probabilities();
        // The last of equals in reverse is the first.
        (0..probabilities.len())
            .rev()
            .max_by(|a, b| probabilities[*a].total_cmp(&probabilities[*b]))
            .unwrap_or(0)
    }

    /// The models at the last measurements in the most probable history, oldest first.
    pub fn most_probable_history(&self) -> &[usize] {
        // Histories are kept best first.
        self.histories.first().map_or(&[], |history| history.path.as_slice())
    }

    /// $`\ln p(z | \text{model active}, \text{all before})`$ of each model at the last measurement, nats; 0 before the first.
    pub fn log_evidence(&self) -> &[LogWeight] {
        &self.log_evidence
    }

    /// The belief of the selected filter in the most probable history in which it is active.
    pub fn estimate(&self) -> Gaussian<M::State> {
        let selected = self.selected();
        let weight = |history: &History<M, F>| history.probability * history.active[selected];
        let best = self.histories.iter().rev().max_by(|a, b| weight(a).total_cmp(&weight(b)));
        best.and_then(|history| history.bank.predicted(selected))
            .expect("invariant: there is a history, and its bank has every model of the chain")
    }

    /// The bank of the most probable history: the belief of every filter, active or not.
    pub fn bank(&self) -> &FilterBank<M, F> {
        &self.histories.first().expect("invariant: there is a history").bank
    }

    /// Every history extended by every possible model, and the evidence of each model.
    #[allow(clippy::type_complexity, reason = "extensions and evidence, as named")]
    fn extended<S>(
        &self,
        sensor: &S,
        measurement: &S::Measurement,
    ) -> Checked<(Vec<Extension<F::Belief>>, Vec<LogWeight>)>
    where
        S: SensorModel<State = M::State>,
        DefaultAllocator: UpdateAlloc<<M::State as Manifold>::Dim, <S::Measurement as Manifold>::Dim>,
    {
        let mut extensions = Vec::new();
        // Per model: ln Σ w N over histories, and that without N.
        let mut joint = vec![f64::NEG_INFINITY; self.chain.n_models()];
        let mut prior = joint.clone();
        for (parent, history) in self.histories.iter().enumerate() {
            for (model, candidate) in history.bank.candidates(sensor, measurement)?.into_iter().enumerate() {
                let before = history.probability.ln() + history.active[model].ln();
                let log_weight = before + candidate.innovation.log_likelihood();
                prior[model] = log_add(prior[model], before);
                joint[model] = log_add(joint[model], log_weight);
                if log_weight > f64::NEG_INFINITY {
                    extensions.push(Extension { parent, model, belief: candidate.belief, log_weight });
                }
            }
        }
        // A model that cannot be active has no evidence either way.
        let evidence = joint
            .iter()
            .zip(&prior)
            .map(|(joint, prior)| if prior.is_finite() { joint - prior } else { *joint });
        Ok((extensions, evidence.collect()))
    }

    /// The history of an extension and its parent.
    fn grown(&self, extension: Extension<F::Belief>, probability: f64) -> History<M, F> {
        let mut history = self.histories[extension.parent].clone();
        history.bank.activate(extension.model, extension.belief);
        history.active.fill(0.0);
        history.active[extension.model] = 1.0;
        history.path.push(extension.model);
        let surplus = history.path.len().saturating_sub(self.params.n_recorded_models);
        history.path.drain(..surplus);
        history.probability = probability;
        history
    }
}

/// $`\ln(e^a + e^b)`$.
fn log_add(a: LogWeight, b: LogWeight) -> LogWeight {
    let (small, large) = if a < b { (a, b) } else { (b, a) };
    if large == f64::NEG_INFINITY { large } else { large + (small - large).exp().ln_1p() }
}
