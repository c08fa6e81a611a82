use crate::{AppearanceMapError, check};

/// How two Gaussians of the same place are combined.
///
/// ```
/// use wayfix_appearance_cml::{GaussianFusionRule, MixtureFusionParams};
/// assert_eq!(MixtureFusionParams::default().fusion_rule, GaussianFusionRule::SplitIntersection);
/// assert_eq!(MixtureFusionParams::as_published().fusion_rule, GaussianFusionRule::WeightedIntersection);
/// ```
#[derive(Clone, Copy, Debug, PartialEq, Eq, Default)]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize), serde(rename_all = "kebab-case"))]
pub enum GaussianFusionRule {
    /// Covariance intersection with the share of Eq. 5 from weights and determinants. [Gross et al. 2005, Eqs. 3–5]
    WeightedIntersection,
    /// Split covariance intersection: fuses the independent parts of the covariances and intersects the rest, with the share of
    /// least determinant. [Julier & Uhlmann 2001]
    #[default]
    SplitIntersection,
}

/// How the weights of two mixtures are combined.
///
/// ```
/// use wayfix_appearance_cml::{MixtureFusionParams, MixtureWeighting};
/// assert_eq!(MixtureFusionParams::default().mixture_weighting, MixtureWeighting::Evidence);
/// assert_eq!(MixtureFusionParams::as_published().mixture_weighting, MixtureWeighting::Support);
/// ```
#[derive(Clone, Copy, Debug, PartialEq, Eq, Default)]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize), serde(rename_all = "kebab-case"))]
pub enum MixtureWeighting {
    /// Weights of matching components add up; the others are copied. [Gross et al. 2005, Eqs. 6–8]
    Support,
    /// Weights are probabilities: each predicted component is integrated over the likelihood ([`fuse`](crate::fuse)).
    #[default]
    Evidence,
}

/// How two mixtures over poses are fused.
///
/// ```
/// use wayfix_appearance_cml::MixtureFusionParams;
/// assert!(MixtureFusionParams::default().gate > MixtureFusionParams::as_published().gate);
/// ```
#[derive(Clone, Copy, Debug, PartialEq)]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
#[cfg_attr(
    feature = "serde",
    derive(serde::Serialize, serde::Deserialize),
    serde(default, deny_unknown_fields)
)]
pub struct MixtureFusionParams {
    /// Squared Mahalanobis distance below which two poses mean one place: $`γ`$ of Eq. 2, $`δ`$ of Eq. 12 and $`d^{max}`$ of Eqs. 15-17.
    /// Default 16.3: 99.9 % of a chi-squared of three degrees of freedom.
    pub gate: f64,
    /// Default [`GaussianFusionRule::SplitIntersection`].
    pub fusion_rule: GaussianFusionRule,
    /// Default [`MixtureWeighting::Evidence`].
    pub mixture_weighting: MixtureWeighting,
}

impl Default for MixtureFusionParams {
    fn default() -> Self {
        Self {
            gate: 16.3,
            fusion_rule: GaussianFusionRule::default(),
            mixture_weighting: MixtureWeighting::default(),
        }
    }
}

impl MixtureFusionParams {
    /// As published: Eqs. 2-8 with the gate at 95 %.
    pub fn as_published() -> Self {
        Self {
            gate: 7.8,
            fusion_rule: GaussianFusionRule::WeightedIntersection,
            mixture_weighting: MixtureWeighting::Support,
        }
    }

    /// Checks the ranges.
    ///
    /// # Errors
    /// Returns an error that names the first number outside its range.
    pub fn validate(&self) -> Result<(), AppearanceMapError> {
        check::positive("gate of the fusion", self.gate)
    }
}
