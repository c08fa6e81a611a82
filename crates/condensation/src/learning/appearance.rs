use nalgebra::{DMatrix, DVector};

use crate::error::{check_size, checked};
use crate::learning::noise::moments;
use crate::learning::response::Response;
use crate::learning::whitener::Whitener;
use crate::{
    AppearanceLearningParams, CondensationError, GlobalDescriptor, LightChange, LikelihoodTail,
    N_DISTURBANCES, StateDescriptorTable, ViewSource,
};

/// The appearance of every state and its variation: the density $`p(m \mid s)`$ of the measurement. [Kasprzak & Szynkiewicz, Sec. 3.1]
///
/// ```math
/// m = M_s + A_s θ + v, \qquad θ ∼ N(0, Θ),\; v ∼ N(0, R_s)
/// ```
///
/// $`M_s`$ are the learned features. $`θ`$, the [`UnknownShiftAndLight`](crate::UnknownShiftAndLight), is the same in every view of a run: a shift of the camera and
/// a change of the light. $`A_s`$ is how the features answer to it and $`R_s`$ what that leaves unexplained, both learned by shifting and
/// relighting what was learned. For light far from that of learning there is one such model a *condition*, each around its own light.
#[derive(Clone, Debug, PartialEq)]
pub struct AppearanceModel {
    pub(super) conditions: Vec<Condition>,
    pub(super) prior: [f64; N_DISTURBANCES], // variances
    pub(super) tail: LikelihoodTail,
    pub(super) n_components: usize,
    half_spacing: f64,
}

/// Every state in one of the lights.
#[derive(Clone, Debug, PartialEq)]
pub(super) struct Condition {
    pub(super) light: LightChange,
    pub(super) features: StateDescriptorTable,
    pub(super) states: Vec<StateModel>,
}

/// One state in one of the lights, with everything whitened by its noise.
#[derive(Clone, Debug, PartialEq)]
pub(super) struct StateModel {
    pub(super) whitener: Whitener,
    pub(super) features: Vec<f64>,
    pub(super) sensitivities: Vec<[f64; N_DISTURBANCES]>, // a row a component
}

impl AppearanceModel {
    /// Learns every state of a source, under every condition of the parameters.
    ///
    /// # Errors
    /// [`CondensationError::Parameter`], [`CondensationError::Empty`] without conditions, or what the source refuses.
    pub fn learn(
        source: &dyn ViewSource,
        feature: &dyn GlobalDescriptor,
        params: &AppearanceLearningParams,
    ) -> Result<Self, CondensationError> {
        params.check()?;
        let learn = |light: &LightChange| Condition::learn(source, feature, light, params);
        Ok(Self {
            conditions: params.light_changes.iter().map(learn).collect::<Result<_, _>>()?,
            prior: params.shift_and_light_sigmas.to_array().map(|sigma| sigma * sigma),
            tail: params.likelihood_tail,
            n_components: feature.n_components(),
            half_spacing: source.half_spacing(),
        })
    }

    /// The paper's likelihood: no disturbance, and each component weighed by its spread over the states, of which noise has a `share`.
    ///
    /// $`w_i = 1 / (\text{share} \cdot σ_i)^2`$: "a weighting vector that adjusts the intervals of particular components to some common interval".
    ///
    /// # Errors
    /// [`CondensationError::Parameter`] when `share` is not positive.
    pub fn from_spread(features: StateDescriptorTable, share: f64) -> Result<Self, CondensationError> {
        checked("share of the spread", share, share.is_finite() && share > 0.0, "finite and positive")?;
        let n_components = features.n_components();
        // A component that never varies weighs nothing, whatever its noise is said to be.
        let variance = |(_, v): &(f64, f64)| if *v > 0.0 { share * share * v } else { 1.0 };
        let variances: Vec<f64> = moments(&features).iter().map(variance).collect();
        let noise = DMatrix::from_diagonal(&DVector::from_vec(variances));
        let blind = DMatrix::zeros(n_components, N_DISTURBANCES);
        let model = |row: &[f64]| StateModel::new(row, &blind, &noise);
        let states = features.rows().map(model).collect::<Result<_, _>>()?;
        Ok(Self {
            conditions: vec![Condition { light: LightChange::SAME, features, states }],
            prior: [0.0; N_DISTURBANCES],
            tail: LikelihoodTail::Gaussian,
            n_components,
            half_spacing: f64::INFINITY,
        })
    }

    /// How many states were learned.
    pub fn n_states(&self) -> usize {
        self.conditions[0].states.len()
    }

    /// How many numbers a measurement has.
    pub fn n_components(&self) -> usize {
        self.n_components
    }

    /// How many lights the model starts from.
    pub fn n_conditions(&self) -> usize {
        self.conditions.len()
    }

    /// The light of a condition, if there is one of that number.
    pub fn light(&self, condition: usize) -> Option<LightChange> {
        self.conditions.get(condition).map(|condition| condition.light)
    }

    /// The learned features in the light of a condition, if there is one of that number.
    pub fn features(&self, condition: usize) -> Option<&StateDescriptorTable> {
        self.conditions.get(condition).map(|condition| &condition.features)
    }

    /// Half the distance between neighbouring states, in pixels: a view shifted by more belongs to the neighbour.
    pub(crate) fn half_spacing(&self) -> f64 {
        self.half_spacing
    }

    /// Whether a measurement has the right size and finite numbers.
    pub(crate) fn check(&self, measurement: &[f64]) -> Result<(), CondensationError> {
        check_size("measurement", self.n_components, measurement.len())?;
        match measurement.iter().enumerate().find(|(_, value)| !value.is_finite()) {
            Some((index, &value)) => Err(CondensationError::NotFinite { what: "measurement", index, value }),
            None => Ok(()),
        }
    }
}

impl Condition {
    fn learn(
        source: &dyn ViewSource,
        feature: &dyn GlobalDescriptor,
        light: &LightChange,
        params: &AppearanceLearningParams,
    ) -> Result<Self, CondensationError> {
        let features = source.features(feature, (0, 0), light)?;
        let response = Response::measure(source, feature, light, &features)?;
        let noise = params.noise_covariance.covariances(&features, &response.residuals);
        let models = features.rows().zip(&response.sensitivities).zip(&noise);
        let states = models.map(|((row, a), r)| StateModel::new(row, a, r)).collect::<Result<_, _>>()?;
        Ok(Self { light: *light, features, states })
    }
}

impl StateModel {
    fn new(
        features: &[f64],
        sensitivities: &DMatrix<f64>,
        noise: &DMatrix<f64>,
    ) -> Result<Self, CondensationError> {
        let whitener = Whitener::new(noise)?;
        let mut white = features.to_vec();
        whitener.whiten(&mut white);
        let mut rows = vec![[0.0; N_DISTURBANCES]; features.len()];
        for (j, column) in sensitivities.column_iter().enumerate() {
            let mut column: Vec<f64> = column.iter().copied().collect();
            whitener.whiten(&mut column);
            rows.iter_mut().zip(column).for_each(|(row, value)| row[j] = value);
        }
        Ok(Self { whitener, features: white, sensitivities: rows })
    }
}
