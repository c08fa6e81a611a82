use nalgebra::{DMatrix, DVector};

use crate::error::checked;
use crate::{CondensationError, StateDescriptorTable};

/// How the covariance of noise is learned from few samples a state.
#[derive(Clone, Copy, Debug, PartialEq)]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize), serde(deny_unknown_fields))]
pub struct NoiseCovarianceParams {
    /// Share of the covariance that is pooled over all states, the rest being the state's own: shrinkage.
    pub pooled_share: f64,
    /// Least variance of a component, as a share of its variance over the states.
    pub min_variance_share: f64,
}

impl Default for NoiseCovarianceParams {
    fn default() -> Self {
        Self { pooled_share: 0.5, min_variance_share: 3e-4 }
    }
}

impl NoiseCovarianceParams {
    pub(super) fn check(&self) -> Result<(), CondensationError> {
        checked(
            "pooled_share",
            self.pooled_share,
            self.pooled_share > 0.0 && self.pooled_share <= 1.0,
            "in (0, 1]",
        )?;
        checked(
            "min_variance_share",
            self.min_variance_share,
            self.min_variance_share >= 0.0 && self.min_variance_share.is_finite(),
            "finite and not negative",
        )?;
        Ok(())
    }

    /// Covariance of every state from residuals `residuals[sample][state]`.
    pub(super) fn covariances(
        &self,
        features: &StateDescriptorTable,
        residuals: &[Vec<DVector<f64>>],
    ) -> Vec<DMatrix<f64>> {
        let (n, k) = (features.n_states(), features.n_components());
        let mut own = vec![DMatrix::zeros(k, k); n];
        for sample in residuals {
            for (covariance, residual) in own.iter_mut().zip(sample) {
                covariance.ger(1.0 / residuals.len() as f64, residual, residual, 1.0);
            }
        }
        let mut pooled = own.iter().fold(DMatrix::zeros(k, k), |sum, c| sum + c) / n as f64;
        for (i, (mean, variance)) in moments(features).into_iter().enumerate() {
            // A component that never varies has no spread to take a share of; it must not make the covariance singular.
            pooled[(i, i)] +=
                (self.min_variance_share * variance + 1e-12 * (1.0 + mean * mean)) / self.pooled_share;
        }
        own.iter_mut().for_each(|c| *c = &*c * (1.0 - self.pooled_share) + &pooled * self.pooled_share);
        own
    }
}

/// Mean and variance of every component over the states.
pub(super) fn moments(features: &StateDescriptorTable) -> Vec<(f64, f64)> {
    let n = features.n_states() as f64;
    let component = |i: usize| features.rows().map(move |row| row[i]);
    (0..features.n_components())
        .map(|i| {
            let mean = component(i).sum::<f64>() / n;
            (mean, component(i).map(|value| (value - mean).powi(2)).sum::<f64>() / n)
        })
        .collect()
}
