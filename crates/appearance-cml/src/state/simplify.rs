use wayfix_gaussian_core::{GaussianError, moment_matched};

use super::PoseHypothesis;
use crate::{AppearanceMapError, check};

/// How a mixture over poses is kept small.
///
/// ```
/// use wayfix_appearance_cml::MixtureReductionParams;
/// assert!(MixtureReductionParams::default().validate().is_ok());
/// assert!(MixtureReductionParams { max_components: 0, ..Default::default() }.validate().is_err());
/// ```
#[derive(Clone, Copy, Debug, PartialEq)]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
#[cfg_attr(
    feature = "serde",
    derive(serde::Serialize, serde::Deserialize),
    serde(default, deny_unknown_fields)
)]
pub struct MixtureReductionParams {
    /// Share of the whole weight below which a component is removed. Default 1e-7: a place that one view finds in a map of 10 000 m² weighs
    /// $`(2π)^{3/2} |C|^{1/2} / V`$, some 1e-6.
    pub min_weight: f64,
    /// Maximum number of components, and of references that a search of the whole map returns. Default 40: the time of a step grows with it.
    pub max_components: usize,
}

impl Default for MixtureReductionParams {
    fn default() -> Self {
        Self { min_weight: 1e-7, max_components: 40 }
    }
}

/// Bhattacharyya distance below which two components become one. The sum of two Gaussians with the same covariance has a single mode up to a
/// distance of 2σ, which is $`4 σ^2 / 8 σ^2`$. A component within one that is 2.4 times as wide in all axes stays apart: it is a place that the robot may have recognized.
const MERGE_DISTANCE: f64 = 0.5;

impl MixtureReductionParams {
    /// Checks the ranges.
    ///
    /// # Errors
    /// Returns an error that names the first number outside its range.
    pub fn validate(&self) -> Result<(), AppearanceMapError> {
        check::share("min_weight of a component", self.min_weight)?;
        check::count("max_components", self.max_components)
    }
}

/// Removes light components, merges overlapping ones and keeps the heaviest, in descending order of weight.
///
/// A merged component has the mean and the covariance of the pair, and the sum of the weights.
///
/// ```
/// use nalgebra::Vector3;
/// use wayfix_appearance_cml::{PoseHypothesis, MixtureReductionParams, simplify};
/// use wayfix_estimation_traits::Pose2;
/// use wayfix_gaussian_core::Gaussian;
/// let at = |x: f64, weight: f64| -> Result<_, wayfix_appearance_cml::AppearanceMapError> {
///     let gaussian = Gaussian::from_sigmas(Pose2::new(x, 0.0, 0.0), &Vector3::new(0.1, 0.1, 0.1))?;
///     Ok(PoseHypothesis::new(weight, gaussian))
/// };
/// let few = simplify(vec![at(0.0, 1.0)?, at(5.0, 1.5)?, at(0.1, 1.0)?, at(9.0, 1e-8)?], &MixtureReductionParams::default())?;
/// assert_eq!(few.iter().map(|h| h.weight).collect::<Vec<_>>(), [2.0, 1.5]);
/// # Ok::<(), wayfix_appearance_cml::AppearanceMapError>(())
/// ```
///
/// # Errors
/// Returns an error if a weight is not finite or negative, all weights are zero, or a covariance is singular.
pub fn simplify(
    mut hypotheses: Vec<PoseHypothesis>,
    params: &MixtureReductionParams,
) -> Result<Vec<PoseHypothesis>, AppearanceMapError> {
    let total = total_weight(&hypotheses)?;
    hypotheses.retain(|h| h.weight >= params.min_weight * total && h.weight > 0.0);
    hypotheses.sort_by(|a, b| b.weight.total_cmp(&a.weight));
    let mut kept: Vec<PoseHypothesis> = Vec::new();
    for hypothesis in hypotheses {
        match nearest_within(&kept, &hypothesis, MERGE_DISTANCE)? {
            Some(index) => {
                let merged = merge(&kept[index], &hypothesis)?;
                kept[index] = merged;
            }
            None => kept.push(hypothesis),
        }
    }
    kept.sort_by(|a, b| b.weight.total_cmp(&a.weight));
    kept.truncate(params.max_components);
    Ok(kept)
}

fn total_weight(hypotheses: &[PoseHypothesis]) -> Result<f64, AppearanceMapError> {
    if let Some(index) = hypotheses.iter().position(|h| !(h.weight >= 0.0 && h.weight.is_finite())) {
        return Err(GaussianError::Weight { index, value: hypotheses[index].weight }.into());
    }
    let total: f64 = hypotheses.iter().map(|h| h.weight).sum();
    if total > 0.0 { Ok(total) } else { Err(GaussianError::NoWeight { count: hypotheses.len() }.into()) }
}

fn nearest_within(
    kept: &[PoseHypothesis],
    hypothesis: &PoseHypothesis,
    reach: f64,
) -> Result<Option<usize>, AppearanceMapError> {
    let mut nearest = None;
    let mut least = reach;
    for (index, other) in kept.iter().enumerate() {
        let distance = other.gaussian.bhattacharyya_distance(&hypothesis.gaussian)?;
        if distance < least {
            (nearest, least) = (Some(index), distance);
        }
    }
    Ok(nearest)
}

fn merge(a: &PoseHypothesis, b: &PoseHypothesis) -> Result<PoseHypothesis, AppearanceMapError> {
    let gaussian = moment_matched(&[a.weight, b.weight], &[a.gaussian.clone(), b.gaussian.clone()])
        .map_err(GaussianError::from)?;
    Ok(PoseHypothesis {
        weight: a.weight + b.weight,
        gaussian,
        independent: a.independent.min(b.independent),
    })
}

#[cfg(test)]
mod tests {
    use approx::assert_abs_diff_eq;
    use nalgebra::Vector3;
    use wayfix_estimation_traits::Pose2;
    use wayfix_gaussian_core::Gaussian;

    use super::*;

    fn at(x: f64, sigma: f64, weight: f64) -> PoseHypothesis {
        let sigmas = Vector3::new(sigma, sigma, 0.1);
        PoseHypothesis::new(weight, Gaussian::from_sigmas(Pose2::new(x, 0.0, 0.0), &sigmas).unwrap())
    }

    fn simplified(hypotheses: &[PoseHypothesis]) -> Vec<PoseHypothesis> {
        simplify(hypotheses.to_vec(), &MixtureReductionParams::default()).unwrap()
    }

    #[test]
    fn equal_components_merge_up_to_two_sigma() {
        for (distance, n_components) in [(1.9, 1), (2.1, 2)] {
            let simplified = simplified(&[at(0.0, 1.0, 1.0), at(distance, 1.0, 1.0)]);
            assert_eq!(simplified.len(), n_components, "{distance}");
        }
    }

    #[test]
    fn narrow_component_within_a_wide_one_is_kept() {
        let simplified = simplified(&[at(0.0, 3.0, 1.0), at(0.5, 0.3, 0.01)]);
        assert_eq!(simplified.len(), 2);
        assert_abs_diff_eq!(simplified[1].gaussian.mean().x(), 0.5);
        assert_abs_diff_eq!(simplified[0].gaussian.sigmas().x, 3.0);
    }
}
