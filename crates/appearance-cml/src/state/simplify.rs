use wayfix_gaussian_core::{GaussianError, moment_matched};

use super::{PoseHypothesis, separation_squared};
use crate::{AppearanceMapError, check};

/// How a mixture over poses is kept small.
#[derive(Clone, Copy, Debug, PartialEq)]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
#[cfg_attr(
    feature = "serde",
    derive(serde::Serialize, serde::Deserialize),
    serde(default, deny_unknown_fields)
)]
pub struct MixtureReductionParams {
    /// Squared Mahalanobis distance below which two components are one. Default 2: they overlap by more than half.
    pub merge_distance: f64,
    /// Share of the whole weight below which a component goes. Default 1e-7: what appears elsewhere starts light.
    pub min_weight: f64,
    /// Most components that are kept. Default 30.
    pub max_components: usize,
}

impl Default for MixtureReductionParams {
    fn default() -> Self {
        Self { merge_distance: 2.0, min_weight: 1e-7, max_components: 30 }
    }
}

impl MixtureReductionParams {
    /// Whether the numbers have a meaning.
    ///
    /// # Errors
    /// Names the first that has none.
    pub fn validate(&self) -> Result<(), AppearanceMapError> {
        check::not_negative("squared distance of components to merge", self.merge_distance)?;
        check::share("least weight of a component", self.min_weight)?;
        check::count("components to keep", self.max_components)
    }
}

/// Drops what is light, merges what overlaps, keeps the heaviest; the heaviest comes first.
///
/// Merging keeps mean and covariance of the pair, weights add.
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
/// When a weight is not finite or negative, all are zero, or a covariance is singular.
pub fn simplify(
    mut hypotheses: Vec<PoseHypothesis>,
    params: &MixtureReductionParams,
) -> Result<Vec<PoseHypothesis>, AppearanceMapError> {
    let total = total_weight(&hypotheses)?;
    hypotheses.retain(|h| h.weight >= params.min_weight * total && h.weight > 0.0);
    hypotheses.sort_by(|a, b| b.weight.total_cmp(&a.weight));
    let mut kept: Vec<PoseHypothesis> = Vec::new();
    for hypothesis in hypotheses {
        match nearest_within(&kept, &hypothesis, params.merge_distance)? {
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
        let squared = separation_squared(&other.gaussian, &hypothesis.gaussian)?;
        if squared < least {
            (nearest, least) = (Some(index), squared);
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
