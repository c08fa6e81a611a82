use wayfix_gaussian_core::{ChiSquaredGate, GaussianError};

use crate::SlamError;

/// Chi-squared quantiles of one probability, computed once: every observation needs them.
#[derive(Clone, Debug)]
pub(super) struct Gates(Vec<f64>);

impl Gates {
    /// Thresholds for measurements of up to `largest` dimensions.
    pub(super) fn from_probability(probability: f64, largest: usize) -> Result<Self, SlamError> {
        let threshold = |dof| ChiSquaredGate::from_probability(dof, probability).map(|gate| gate.threshold());
        let thresholds: Result<_, GaussianError> = (1..=largest).map(threshold).collect();
        let range = "between 0 and 1, exclusive";
        let out_of_range = |_| SlamError::Parameter { name: "gate_probability", value: probability, range };
        thresholds.map(Self).map_err(out_of_range)
    }

    /// Threshold for measurements of this dimension; beyond the largest dimension 0, which rejects all.
    pub(super) fn threshold(&self, dimension: usize) -> f64 {
        dimension.checked_sub(1).and_then(|index| self.0.get(index)).copied().unwrap_or(0.0)
    }
}
