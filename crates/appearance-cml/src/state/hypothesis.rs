use wayfix_estimation_traits::Pose2;
use wayfix_gaussian_core::{Gaussian, GaussianMixture};

use crate::AppearanceMapError;

/// One weighted Gaussian of a mixture over poses. The weights are normalized after the last source is fused. [Gross et al. 2005, Sec. 2.1, Eq. 1]
///
/// ```
/// use nalgebra::Vector3;
/// use wayfix_appearance_cml::PoseHypothesis;
/// use wayfix_estimation_traits::Pose2;
/// use wayfix_gaussian_core::Gaussian;
/// let pose = Gaussian::from_sigmas(Pose2::new(1.0, 0.0, 0.0), &Vector3::new(0.1, 0.1, 0.1))?;
/// let mixture = PoseHypothesis::into_mixture(vec![PoseHypothesis::new(3.0, pose.clone()), PoseHypothesis::new(1.0, pose)])?;
/// assert!((mixture.weight(0) - 0.75).abs() < 1e-12);
/// # Ok::<(), wayfix_appearance_cml::AppearanceMapError>(())
/// ```
#[derive(Clone, Debug, PartialEq)]
pub struct PoseHypothesis {
    /// The weight relative to other hypotheses; finite and not negative.
    pub weight: f64,
    /// The pose, in metres and radians; covariance in the body frame.
    pub gaussian: Gaussian<Pose2<f64>>,
    /// Share of the covariance that is independent of all other hypotheses, in [0, 1]: 0 for odometry and map, 1 for a new measurement
    /// such as a GPS fix.
    pub independent: f64,
}

impl PoseHypothesis {
    /// A hypothesis that may share its errors with any other.
    pub fn new(weight: f64, gaussian: Gaussian<Pose2<f64>>) -> Self {
        Self { weight, gaussian, independent: 0.0 }
    }

    /// The components of a normalized mixture.
    pub(crate) fn of_mixture(mixture: &GaussianMixture<Pose2<f64>>) -> Vec<Self> {
        let weighted = mixture.weights().into_iter().zip(mixture.components());
        weighted.map(|(weight, gaussian)| Self::new(weight, gaussian.clone())).collect()
    }

    /// The normalized mixture.
    ///
    /// # Errors
    /// Returns an error if there are no hypotheses, a weight is negative or not finite, or all are zero.
    pub fn into_mixture(hypotheses: Vec<Self>) -> Result<GaussianMixture<Pose2<f64>>, AppearanceMapError> {
        Ok(GaussianMixture::from_weights(hypotheses.into_iter().map(|h| (h.weight, h.gaussian)).collect())?)
    }
}
