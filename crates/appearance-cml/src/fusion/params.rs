use crate::{AppearanceMapError, check};

/// Fusion of two Gaussians of one place.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Default)]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize), serde(rename_all = "kebab-case"))]
pub enum GaussianFusionRule {
    /// Covariance intersection with the share of Eq. 5 from weights and determinants. [Gross et al. 2005, Eqs. 3-5]
    WeightedIntersection,
    /// Split covariance intersection: what is independent in a covariance is fused as such, the rest is intersected, with the
    /// share that makes the result smallest. [Julier & Uhlmann 2001]
    #[default]
    SplitIntersection,
}

/// Weight of a fused component, from its weights in both mixtures.
#[derive(Clone, Copy, Debug, PartialEq)]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize), serde(rename_all = "kebab-case"))]
pub enum MixtureWeighting {
    /// Weights of what agrees add up; what is alone keeps its weight and loses it by the normalization. [Gross et al. 2005, Eqs. 6-8]
    Support,
    /// Weights are probabilities: with each counterpart a component has the weight $`w_a w_b e^{-d^2/2}`$, and it remains as it is, with the chance
    /// $`w_a m`$ that the view is not recognized where it should be: the missed detection of probabilistic data association [Bar-Shalom & Tse 1975].
    Evidence {
        /// $`m`$: not being recognized, beside 1 for a counterpart that looks exactly the same.
        missed: f64,
        /// Factor of something new that no hypothesis foresaw: the chance that the robot was carried there.
        appeared: f64,
    },
}

impl Default for MixtureWeighting {
    fn default() -> Self {
        Self::Evidence { missed: 0.2, appeared: 1e-5 }
    }
}

/// How two mixtures over poses are fused.
#[derive(Clone, Copy, Debug, PartialEq)]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
#[cfg_attr(
    feature = "serde",
    derive(serde::Serialize, serde::Deserialize),
    serde(default, deny_unknown_fields)
)]
pub struct FusionParams {
    /// Squared Mahalanobis distance $`γ`$ below which two components mean one place.
    /// Default 16.3: 99.9 % of a chi-squared of three degrees of freedom.
    pub gate: f64,
    /// Default [`GaussianFusionRule::SplitIntersection`].
    pub fusion_rule: GaussianFusionRule,
    /// Default [`MixtureWeighting::Evidence`].
    pub mixture_weighting: MixtureWeighting,
}

impl Default for FusionParams {
    fn default() -> Self {
        Self {
            gate: 16.3,
            fusion_rule: GaussianFusionRule::default(),
            mixture_weighting: MixtureWeighting::default(),
        }
    }
}

impl FusionParams {
    /// As printed: Eqs. 2-8 with the gate at 95 %.
    pub fn as_published() -> Self {
        Self {
            gate: 7.8,
            fusion_rule: GaussianFusionRule::WeightedIntersection,
            mixture_weighting: MixtureWeighting::Support,
        }
    }

    /// Whether the numbers have a meaning.
    ///
    /// # Errors
    /// Names the first that has none.
    pub fn validate(&self) -> Result<(), AppearanceMapError> {
        check::positive("gate of the fusion", self.gate)?;
        if let MixtureWeighting::Evidence { missed, appeared } = self.mixture_weighting {
            check::share("weight of a hypothesis that is missed", missed)?;
            check::share("weight of a hypothesis that appears", appeared)?;
        }
        Ok(())
    }
}
