use statrs::distribution::{ChiSquared, ContinuousCDF};

use crate::error::{check_size, check_state};
use crate::{AppearanceModel, CondensationError, StateDescriptorTable};

/// Least, greatest and mean p-value over pairs, as in the paper's Tables 1 and 2.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct PValueStatistics {
    /// The least.
    pub min: f64,
    /// The greatest.
    pub max: f64,
    /// The mean.
    pub mean: f64,
}

impl AppearanceModel {
    /// How likely the features of a view of `state` are as far from the learned ones as `measurement` is, or farther.
    ///
    /// The chi-squared tail at the squared Mahalanobis distance $`(m - M_s)^T (A_s Θ A_s^T + R_s)^{-1} (m - M_s)`$ in the first condition: near
    /// 0 the views are distinct, near 1 the same. The paper does not name its test; this is ours.
    ///
    /// # Errors
    /// [`CondensationError::State`], [`CondensationError::Dimension`], [`CondensationError::NotFinite`].
    pub fn p_value(&self, state: usize, measurement: &[f64]) -> Result<f64, CondensationError> {
        check_state(state, self.n_states())?;
        self.check(measurement)?;
        Ok(self.tail_probability(state, measurement))
    }

    /// P-values of all pairs of different states [Kasprzak & Szynkiewicz, Table 1]: how distinct the learned views are. None for a single state.
    pub fn p_values_between_states(&self) -> Option<PValueStatistics> {
        let rows = || self.conditions[0].features.rows().enumerate();
        summarize(rows().flat_map(|(state, _)| {
            rows()
                .filter(move |(other, _)| *other != state)
                .map(move |(_, row)| self.tail_probability(state, row))
        }))
    }

    /// P-values of each state's view in another scene [Kasprzak & Szynkiewicz, Table 2]: how alike views of the same state are.
    ///
    /// # Errors
    /// [`CondensationError::Dimension`] when the table is of other states or features.
    pub fn p_values_of(&self, seen: &StateDescriptorTable) -> Result<PValueStatistics, CondensationError> {
        check_size("table of features", self.n_states(), seen.n_states())?;
        check_size("feature vector", self.n_components, seen.n_components())?;
        let each = seen.rows().enumerate().map(|(state, row)| self.tail_probability(state, row));
        summarize(each).ok_or(CondensationError::Empty { what: "states" })
    }

    fn tail_probability(&self, state: usize, measurement: &[f64]) -> f64 {
        let distance = self.squared_distance(state, measurement);
        ChiSquared::new(measurement.len() as f64).map_or(f64::NAN, |chi_squared| chi_squared.sf(distance))
    }

    fn squared_distance(&self, state: usize, measurement: &[f64]) -> f64 {
        let mut scratch = vec![0.0; measurement.len()];
        self.innovation((0, state), measurement, &mut self.prior_belief(), &mut scratch).0
    }
}

fn summarize(values: impl Iterator<Item = f64>) -> Option<PValueStatistics> {
    let (mut n, mut sum) = (0_usize, 0.0);
    let (mut min, mut max) = (f64::INFINITY, f64::NEG_INFINITY);
    for value in values {
        (n, sum) = (n + 1, sum + value);
        (min, max) = (min.min(value), max.max(value));
    }
    (n > 0).then(|| PValueStatistics { min, max, mean: sum / n as f64 })
}
