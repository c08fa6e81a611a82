use crate::error::checked;
use crate::{CondensationError, LightChange, LikelihoodTail, NoiseCovarianceParams, UnknownShiftAndLight};

/// How appearance is learned. None of it depends on the scene.
#[derive(Clone, Debug, PartialEq)]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize), serde(deny_unknown_fields))]
pub struct AppearanceLearningParams {
    /// Standard deviations of the disturbance around each condition.
    pub shift_and_light_sigmas: UnknownShiftAndLight,
    /// The lights of the conditions, as they differ from that of learning.
    pub light_changes: Vec<LightChange>,
    /// Noise that no disturbance explains.
    pub noise_covariance: NoiseCovarianceParams,
    /// How fast likelihood falls with distance.
    pub likelihood_tail: LikelihoodTail,
}

impl AppearanceLearningParams {
    /// For views normalized from statistics of the whole scene.
    ///
    /// What is left is a shift of some pixels (a standard deviation of 2.4 on each axis, so that five pixels are probable) and a light
    /// that normalization missed: the scene in view is not quite the one learned, and grey values are rounded twice. That is a few per cent,
    /// but not exactly of the form gain, offset, gamma, so a tenth is allowed for.
    pub fn normalized() -> Self {
        Self {
            shift_and_light_sigmas: UnknownShiftAndLight {
                dx: 2.4,
                dy: 2.4,
                gain: 0.1,
                offset: 8.0,
                log_gamma: 0.1,
            },
            light_changes: vec![LightChange::SAME],
            noise_covariance: NoiseCovarianceParams::default(),
            likelihood_tail: LikelihoodTail::default(),
        }
    }

    /// For views as the camera gives them: the light is estimated together with the place, from no knowledge.
    ///
    /// Three gains times five gammas in geometric steps cover 0.5 to 1.4 and 0.56 to 1.8; around each the disturbance reaches half way to the
    /// next. The features are nearly linear in the offset, so that one of ± 20 grey levels (one sigma) needs no conditions.
    ///
    /// ```
    /// use wayfix_condensation::AppearanceLearningParams;
    /// assert_eq!(AppearanceLearningParams::online().light_changes.len(), 15);
    /// ```
    pub fn online() -> Self {
        let gammas = (-2..=2).map(|i| 2.0_f64.powf(f64::from(i) / 3.0));
        let lights =
            gammas.flat_map(|gamma| [0.6, 0.85, 1.2].map(|gain| LightChange { gain, offset: 0.0, gamma }));
        Self {
            shift_and_light_sigmas: UnknownShiftAndLight {
                dx: 2.4,
                dy: 2.4,
                gain: 0.12,
                offset: 20.0,
                log_gamma: 0.12,
            },
            light_changes: lights.collect(),
            ..Self::normalized()
        }
    }

    /// The published likelihood: a Gaussian of the weighted distance, $`e^{-\frac{1}{2} \sum_i w_i (m_i - m_i(s))^2}`$, whose weights are one over the variances of the
    /// features over the states; no disturbance is known. [Kasprzak & Szynkiewicz, Sec. 2.3]
    ///
    /// ```
    /// use wayfix_condensation::{AppearanceLearningParams, LikelihoodTail};
    /// let published = AppearanceLearningParams::as_published();
    /// assert_eq!(published.likelihood_tail, LikelihoodTail::Gaussian);
    /// assert!(published.shift_and_light_sigmas.to_array().iter().all(|sigma| *sigma == 0.0));
    /// ```
    pub fn as_published() -> Self {
        Self {
            shift_and_light_sigmas: UnknownShiftAndLight {
                dx: 0.0,
                dy: 0.0,
                gain: 0.0,
                offset: 0.0,
                log_gamma: 0.0,
            },
            light_changes: vec![LightChange::SAME],
            noise_covariance: NoiseCovarianceParams { pooled_share: 1.0, min_variance_share: 1.0 },
            likelihood_tail: LikelihoodTail::Gaussian,
        }
    }

    pub(super) fn check(&self) -> Result<(), CondensationError> {
        for sigma in self.shift_and_light_sigmas.to_array() {
            let valid = sigma.is_finite() && sigma >= 0.0;
            checked("sigma of the disturbance", sigma, valid, "finite and not negative")?;
        }
        if self.light_changes.is_empty() {
            return Err(CondensationError::Empty { what: "conditions" });
        }
        self.noise_covariance.check()?;
        self.likelihood_tail.check()
    }
}
