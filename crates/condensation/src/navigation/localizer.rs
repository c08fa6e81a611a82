use std::sync::Arc;

use statrs::function::erf::erf;
use wayfix_estimation_traits::LogWeight;

use crate::discrete::entropy;
use crate::error::{check_size, probability};
use crate::learning::DisturbanceBelief;
use crate::navigation::moment_transition::MomentTransition;
use crate::{
    AppearanceModel, CondensationError, DiscreteFilter, LightChange, MeasurementOutcome, MostProbableState,
    TransitionModel, UnknownShiftAndLight,
};

/// What a localizer assumes of the run.
#[derive(Clone, Copy, Debug, PartialEq)]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize), serde(deny_unknown_fields))]
pub struct ViewLocalizerParams {
    /// Share of the belief that becomes uniform in a step: kidnapping, or a place where the model is wrong.
    pub kidnapping_probability: f64,
    /// How much the disturbance may drift in a step, as a share of its prior variance.
    pub shift_and_light_drift: f64,
}

impl ViewLocalizerParams {
    /// The published filter: no kidnapping and no drift.
    pub fn as_published() -> Self {
        Self { kidnapping_probability: 0.0, shift_and_light_drift: 0.0 }
    }
}

impl Default for ViewLocalizerParams {
    /// Carried off once in a thousand steps; a disturbance that takes as many to be forgotten.
    fn default() -> Self {
        Self { kidnapping_probability: 1e-3, shift_and_light_drift: 1e-3 }
    }
}

/// Place, light and shift estimated together from global features.
///
/// A discrete Bayes filter over the product of places and conditions, in which every state carries its own Gaussian belief over the
/// [`UnknownShiftAndLight`]: the fit of the views on the path to this state gives the light. At first every place
/// explains the view by a light of its own; later views agree with one of them only.
///
/// ```
/// use std::sync::Arc;
/// use wayfix_condensation::{AppearanceModel, StateDescriptorTable, ViewLocalizer, ViewLocalizerParams};
/// let learned = StateDescriptorTable::from_rows(&[vec![10.0], vec![20.0], vec![30.0]])?;
/// let appearance = Arc::new(AppearanceModel::from_spread(learned, 0.1)?);
/// let mut localizer = ViewLocalizer::new(appearance, ViewLocalizerParams::default())?;
/// localizer.update(&[21.0])?.evidence().expect("possible");
/// assert_eq!(localizer.best().state, 1);
/// assert!(localizer.update(&[f64::NAN]).is_err());
/// # Ok::<(), wayfix_condensation::CondensationError>(())
/// ```
#[derive(Clone, Debug)]
pub struct ViewLocalizer {
    appearance: Arc<AppearanceModel>,
    params: ViewLocalizerParams,
    filter: DiscreteFilter, // place fastest, then condition
    disturbances: Vec<DisturbanceBelief>,
    places: Vec<f64>,
}

impl ViewLocalizer {
    /// Nothing known: neither place nor light.
    ///
    /// # Errors
    /// [`CondensationError::Parameter`] when leak or drift is no share.
    pub fn new(
        appearance: Arc<AppearanceModel>,
        params: ViewLocalizerParams,
    ) -> Result<Self, CondensationError> {
        probability("kidnapping_probability", params.kidnapping_probability)?;
        probability("shift_and_light_drift", params.shift_and_light_drift)?;
        let n_places = appearance.n_states();
        let n = n_places * appearance.n_conditions();
        Ok(Self {
            filter: DiscreteFilter::uniform(n)?,
            disturbances: vec![appearance.prior_belief(); n],
            places: vec![1.0 / n_places as f64; n_places],
            appearance,
            params,
        })
    }

    /// Belief after a move: every state takes its disturbance along.
    ///
    /// # Errors
    /// [`CondensationError::Dimension`] when the transition is of another space.
    pub fn predict(&mut self, transition: &dyn TransitionModel) -> Result<(), CondensationError> {
        let n = self.places.len();
        check_size("transition", n, transition.n_states())?;
        let mut next = self.filter.belief().to_vec();
        let conditions = next.chunks_mut(n).zip(self.disturbances.chunks_mut(n));
        for (belief, disturbances) in conditions {
            MomentTransition { transition, leak: self.params.kidnapping_probability }
                .apply(belief, disturbances);
            disturbances.iter_mut().for_each(|d| self.appearance.widen(d, self.params.shift_and_light_drift));
        }
        self.filter = DiscreteFilter::from_prior(next)?;
        self.sum_places();
        Ok(())
    }

    /// Belief after a view; `measurement` are the features of the view.
    ///
    /// # Errors
    /// [`CondensationError::Dimension`] or [`CondensationError::NotFinite`]; the belief is as it was.
    pub fn update(&mut self, measurement: &[f64]) -> Result<MeasurementOutcome, CondensationError> {
        self.appearance.check(measurement)?;
        let n = self.places.len();
        let mut scratch = vec![0.0; measurement.len()];
        let mut updated = self.disturbances.clone();
        let log_likelihoods: Vec<LogWeight> = updated
            .iter_mut()
            .enumerate()
            .map(|(i, belief)| self.appearance.absorb((i / n, i % n), measurement, belief, &mut scratch))
            .collect();
        let outcome = self.filter.update(&log_likelihoods)?;
        if outcome != MeasurementOutcome::Impossible {
            self.disturbances = updated;
            self.sum_places();
        }
        Ok(outcome)
    }

    /// Resets the belief to uniform. The caller decides what to do after a kidnapping, never the filter.
    pub fn reset(&mut self) {
        let n = self.disturbances.len();
        self.filter = DiscreteFilter::uniform(n).expect("invariant: there were states before");
        self.disturbances.fill(self.appearance.prior_belief());
        let everywhere = 1.0 / self.places.len() as f64;
        self.places.fill(everywhere);
    }

    /// The belief over places, one probability a state.
    pub fn belief(&self) -> &[f64] {
        &self.places
    }

    /// The place with the largest belief.
    pub fn best(&self) -> MostProbableState {
        let better = |best: MostProbableState, (state, &confidence): (usize, &f64)| {
            if confidence > best.confidence { MostProbableState { state, confidence } } else { best }
        };
        self.places.iter().enumerate().fold(MostProbableState { state: 0, confidence: 0.0 }, better)
    }

    /// Entropy of the belief over places, in nats.
    pub fn entropy(&self) -> f64 {
        entropy(&self.places)
    }

    /// The light and the shift where belief is largest.
    pub fn disturbance(&self) -> (LightChange, UnknownShiftAndLight) {
        let best = self.filter.best().state;
        let light = self.appearance.light(best / self.places.len()).unwrap_or(LightChange::SAME);
        let disturbance = UnknownShiftAndLight::from_array(self.disturbances[best].mean);
        (disturbance.applied_to(light), disturbance)
    }

    /// What was learned.
    pub fn appearance(&self) -> &AppearanceModel {
        &self.appearance
    }

    /// Likelihood of the view of `state` in state `other`, in the best condition and with the estimated disturbance there.
    pub(crate) fn confusion(&self, state: usize, other: usize) -> LogWeight {
        let n = self.places.len();
        let condition = self.filter.best().state / n;
        let Some(features) = self.appearance.features(condition) else { return 0.0 };
        let mut belief = self.disturbances[condition * n + other];
        belief.mean.fill(0.0); // `state` is imagined without a disturbance
        let mut scratch = vec![0.0; self.appearance.n_components()];
        self.appearance.absorb((condition, other), features.row(state), &mut belief, &mut scratch)
    }

    /// Sums over the conditions. A shift of more than half the spacing makes the view one of the neighbour's, so that part of each
    /// Gaussian does not count.
    fn sum_places(&mut self) {
        let n = self.places.len();
        let half = self.appearance.half_spacing();
        self.places.fill(0.0);
        for (i, (p, disturbance)) in self.filter.belief().iter().zip(&self.disturbances).enumerate() {
            self.places[i % n] += p * disturbance.within(0, half) * disturbance.within(1, half);
        }
        let sum: f64 = self.places.iter().sum();
        if sum > 0.0 {
            self.places.iter_mut().for_each(|p| *p /= sum);
        }
    }
}

impl DisturbanceBelief {
    /// The probability that a coordinate lies within `half` of zero.
    fn within(&self, coordinate: usize, half: f64) -> f64 {
        let scale = (2.0 * self.covariance[coordinate][coordinate]).sqrt();
        if half.is_infinite() || scale <= 0.0 {
            return 1.0;
        }
        let mean = self.mean[coordinate];
        0.5 * (erf((half - mean) / scale) + erf((half + mean) / scale))
    }
}
