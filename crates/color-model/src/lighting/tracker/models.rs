//! The lighting filter in terms of `wayfix-kalman`: motion model and measurement model of the light.

use std::sync::Arc;

use nalgebra::{DMatrix, DVector, Vector3};
use wayfix_estimation_traits::MotionModel;
use wayfix_gaussian_core::Gaussian;
use wayfix_kalman::LinearSensor;

use super::super::LightingDrift;
use crate::{ColorMeans, ColorModelError, LightingFilter};

/// Motion of the light over an interval (the control).
#[derive(Clone, Debug)]
pub(super) enum LightMotion {
    /// It drifts.
    Drift { drift: LightingDrift, prior: Arc<Gaussian<DVector<f64>>> },
    /// The light switches to another one and restarts at its prior.
    Switch { to: Arc<Gaussian<DVector<f64>>> },
}

impl LightMotion {
    pub(super) fn drift_of(filter: &LightingFilter) -> Self {
        Self::Drift { drift: filter.params().lighting_drift, prior: Arc::new(filter.prior().clone()) }
    }
}

impl MotionModel for LightMotion {
    type State = DVector<f64>;
    type Control = f64;

    fn propagate(&self, state: &DVector<f64>, seconds: &f64) -> DVector<f64> {
        match self {
            Self::Drift { drift, prior } => {
                let mut mean = state.clone();
                drift.move_mean(*seconds, prior, &mut mean);
                mean
            }
            Self::Switch { to } => to.mean().clone(),
        }
    }

    fn jacobian(&self, state: &DVector<f64>, seconds: &f64) -> DMatrix<f64> {
        let n = state.len();
        match self {
            Self::Drift { drift: LightingDrift::RandomWalk(_), .. } => DMatrix::identity(n, n),
            Self::Drift { drift: LightingDrift::TowardsPrior(time_constant), .. } => {
                DMatrix::from_diagonal_element(n, n, (-seconds / time_constant).exp())
            }
            Self::Switch { .. } => DMatrix::zeros(n, n),
        }
    }

    fn noise(&self, state: &DVector<f64>, seconds: &f64) -> DMatrix<f64> {
        match self {
            Self::Drift { drift, prior } => {
                let mut noise = DMatrix::zeros(state.len(), state.len());
                drift.widen(*seconds, prior, |_| f64::INFINITY, &mut noise);
                noise
            }
            Self::Switch { to } => to.covariance().clone(),
        }
    }
}

pub(super) type ColorSensor = LinearSensor<DVector<f64>, DVector<f64>>;

/// The rows of the state that an image shows, and their values; `None` for an image without map colours.
pub(super) fn seen(
    means: &ColorMeans,
    noise: &Vector3<f64>,
) -> Result<Option<(ColorSensor, DVector<f64>)>, ColorModelError> {
    let rows: Vec<(usize, f64)> = means
        .seen()
        .flat_map(|(color, mean)| (0..3).map(move |channel| (3 * color.index() + channel, mean[channel])))
        .collect();
    if rows.is_empty() {
        return Ok(None);
    }
    let mut matrix = DMatrix::zeros(rows.len(), 3 * means.n_colors());
    for (row, (column, _)) in rows.iter().enumerate() {
        matrix[(row, *column)] = 1.0;
    }
    let variances = DVector::from_iterator(rows.len(), rows.iter().map(|(column, _)| noise[column % 3]));
    let sensor = LinearSensor::new(matrix, DMatrix::from_diagonal(&variances))?;
    Ok(Some((sensor, DVector::from_iterator(rows.len(), rows.into_iter().map(|(_, value)| value)))))
}
