use wayfix_estimation_traits::Pose2;
use wayfix_gaussian_core::{Gaussian, GaussianMixture};

use crate::AppearanceMapError;

/// One Gaussian of a mixture over poses whose weights need not add up to one.
///
/// Sources of information speak in these, because weights are normalized only after the last source is fused.
/// [Gross et al. 2005, Sec. 2.1]
#[derive(Clone, Debug, PartialEq)]
pub struct PoseHypothesis {
    /// How certain it is beside others; finite and not negative.
    pub weight: f64,
    /// Where, in metres and radians; covariance in the body frame.
    pub gaussian: Gaussian<Pose2<f64>>,
    /// Share of the covariance whose error no other hypothesis has a part in, in [0, 1]: 0 for what odometry and map have said
    /// before, 1 for a fresh measurement such as a GPS fix.
    pub independent: f64,
}

impl PoseHypothesis {
    /// A hypothesis that may share its errors with any other.
    pub fn new(weight: f64, gaussian: Gaussian<Pose2<f64>>) -> Self {
        Self { weight, gaussian, independent: 0.0 }
    }

    /// The components of a normalized mixture.
    pub fn of_mixture(mixture: &GaussianMixture<Pose2<f64>>) -> Vec<Self> {
        let weighted = mixture.weights().into_iter().zip(mixture.components());
        weighted.map(|(weight, gaussian)| Self::new(weight, gaussian.clone())).collect()
    }

    /// Normalizes.
    ///
    /// # Errors
    /// When there are no hypotheses, a weight is negative or not finite, or all are zero.
    pub fn into_mixture(hypotheses: Vec<Self>) -> Result<GaussianMixture<Pose2<f64>>, AppearanceMapError> {
        Ok(GaussianMixture::from_weights(hypotheses.into_iter().map(|h| (h.weight, h.gaussian)).collect())?)
    }
}
