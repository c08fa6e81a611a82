use wayfix_estimation_traits::LogWeight;

use crate::{GaussianError, index_set::complement};

/// The sufficient statistics of a group's observations of its own mean $`θ_j`$: per coordinate a mean and its variance.
///
/// An observation is some coordinates of $`θ_j`$ plus independent noise of known variance. Such observations pool without loss:
/// precisions add, so a group of a thousand costs what a group of one does.
///
/// ```
/// use wayfix_gaussian_core::PooledGroupEstimate;
/// let mut group = PooledGroupEstimate::new(3);
/// group.observe(&[0, 2], &[1.0, 5.0], &[0.1, 0.1])?;
/// group.observe(&[0], &[3.0], &[0.1])?;
/// let (mean, variance) = group.estimate(0).unwrap();
/// assert!((mean - 2.0_f64).abs() < 1e-15 && (variance - 0.05_f64).abs() < 1e-15);
/// assert_eq!(group.estimate(1), None);
/// # Ok::<(), wayfix_gaussian_core::GaussianError>(())
/// ```
#[derive(Clone, Debug, PartialEq)]
pub struct PooledGroupEstimate {
    coordinates: Vec<Option<Estimate>>,
    log_agreement: LogWeight,
}

#[derive(Clone, Copy, Debug, PartialEq)]
struct Estimate {
    mean: f64,
    variance: f64,
}

impl PooledGroupEstimate {
    /// A group of `dimension` coordinates without observations.
    pub fn new(dimension: usize) -> Self {
        Self { coordinates: vec![None; dimension], log_agreement: 0.0 }
    }

    /// Adds one observation: `values` of the coordinates `indices`, with noise `variances` (0 for exact ones).
    ///
    /// # Errors
    /// When the lists differ in length, an index is out of range or repeated, a value is not finite, a variance is negative or not
    /// finite, or a coordinate known exactly is observed exactly once more (the density of that is zero or infinite).
    pub fn observe(
        &mut self,
        indices: &[usize],
        values: &[f64],
        variances: &[f64],
    ) -> Result<(), GaussianError> {
        complement(indices, self.dimension())?;
        for (what, list) in [("values", values), ("variances", variances)] {
            if list.len() != indices.len() {
                return Err(GaussianError::Dimension { what, expected: indices.len(), got: list.len() });
            }
        }
        let pooled = (0..indices.len())
            .map(|k| pool(self.coordinates[indices[k]], values[k], variances[k]))
            .collect::<Result<Vec<_>, _>>()?;
        for (&index, (estimate, log_agreement)) in indices.iter().zip(pooled) {
            self.coordinates[index] = Some(estimate);
            self.log_agreement += log_agreement;
        }
        Ok(())
    }

    /// The number of coordinates of $`θ_j`$.
    pub fn dimension(&self) -> usize {
        self.coordinates.len()
    }

    /// The pooled observation of coordinate `index` and its variance, if there is one.
    pub fn estimate(&self, index: usize) -> Option<(f64, f64)> {
        self.coordinates.get(index).copied().flatten().map(|estimate| (estimate.mean, estimate.variance))
    }

    /// The coordinates observed, ascending.
    pub fn observed(&self) -> impl Iterator<Item = usize> {
        self.coordinates.iter().enumerate().filter(|(_, estimate)| estimate.is_some()).map(|(index, _)| index)
    }

    /// The part of the observations' log density in which $`θ_j`$ does not occur: how well they agree with each other.
    ///
    /// $`\prod_i N(y_i; θ, v_i) = N(\bar y; θ, \bar v) · e^{a}`$ with this $`a`$.
    pub(crate) fn log_agreement(&self) -> LogWeight {
        self.log_agreement
    }
}

/// One coordinate's estimate with one more observation, and the log density of that observation given the earlier ones.
fn pool(known: Option<Estimate>, value: f64, variance: f64) -> Result<(Estimate, LogWeight), GaussianError> {
    if !value.is_finite() {
        return Err(GaussianError::NotFinite { what: "observed value" });
    }
    if !(variance >= 0.0 && variance.is_finite()) {
        let range = "finite and at least 0";
        return Err(GaussianError::Parameter { what: "noise variance", value: variance, range });
    }
    let Some(known) = known else { return Ok((Estimate { mean: value, variance }, 0.0)) };
    let total = known.variance + variance;
    if total == 0.0 {
        let range = "positive where a coordinate is exactly known already";
        return Err(GaussianError::Parameter { what: "noise variance", value: variance, range });
    }
    let residual = value - known.mean;
    let share = known.variance / total;
    let pooled = Estimate { mean: known.mean + share * residual, variance: share * variance };
    let log_density = -0.5 * (residual * residual / total + (2.0 * std::f64::consts::PI * total).ln());
    if pooled.mean.is_finite() && log_density.is_finite() {
        Ok((pooled, log_density))
    } else {
        Err(GaussianError::NotFinite { what: "pooled observation" })
    }
}

#[cfg(test)]
mod tests {
    use approx::assert_abs_diff_eq;

    use super::*;
    use crate::Gaussian;
    use nalgebra::Vector1;

    #[test]
    fn pooling_loses_nothing_of_the_density() {
        let (values, variances) = ([1.0, 4.0, 2.5], [0.5, 2.0, 1.0]);
        let mut group = PooledGroupEstimate::new(1);
        for (value, variance) in values.iter().zip(variances) {
            group.observe(&[0], &[*value], &[variance]).unwrap();
        }
        let log_density = |x: f64, mean: f64, variance: f64| {
            let sigma = Vector1::new(variance.sqrt());
            Gaussian::from_sigmas(Vector1::new(mean), &sigma).unwrap().log_density(&Vector1::new(x)).unwrap()
        };
        for theta in [-3.0, 0.0, 7.0] {
            let one_by_one: f64 = values.iter().zip(variances).map(|(y, v)| log_density(*y, theta, v)).sum();
            let (mean, variance) = group.estimate(0).unwrap();
            let pooled = log_density(mean, theta, variance) + group.log_agreement();
            // Ten-odd roundings of terms below 200.
            assert_abs_diff_eq!(one_by_one, pooled, epsilon = 1e-12);
        }
    }

    #[test]
    fn a_refused_observation_leaves_the_group_as_it_was() {
        let mut group = PooledGroupEstimate::new(2);
        group.observe(&[0], &[1.0], &[0.0]).unwrap();
        let before = group.clone();
        assert!(group.observe(&[1, 2], &[0.0, 0.0], &[1.0, 1.0]).is_err());
        assert!(group.observe(&[1, 1], &[0.0, 0.0], &[1.0, 1.0]).is_err());
        assert!(group.observe(&[1, 0], &[0.0], &[1.0, 1.0]).is_err());
        assert!(group.observe(&[1, 0], &[0.0, 1.0], &[1.0]).is_err());
        assert!(group.observe(&[1, 0], &[0.0, f64::NAN], &[1.0, 1.0]).is_err());
        assert!(group.observe(&[1, 0], &[0.0, 1.0], &[1.0, -1.0]).is_err());
        assert!(group.observe(&[1, 0], &[0.0, 1.0], &[1.0, f64::INFINITY]).is_err());
        assert!(group.observe(&[1, 0], &[0.0, 1.0], &[1.0, 0.0]).is_err(), "known exactly twice");
        assert!(group.observe(&[1, 0], &[0.0, 1e200], &[1.0, 1e-200]).is_err(), "density underflows");
        assert_eq!(group, before);
    }
}
