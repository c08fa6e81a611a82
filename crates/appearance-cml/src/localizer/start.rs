use wayfix_estimation_traits::Pose2;
use wayfix_gaussian_core::{Gaussian, GaussianMixture};

use crate::AppearanceMapError;

/// The pose of the robot at the start.
///
/// ```
/// # use nalgebra::Vector3;
/// # use wayfix_appearance_cml::{AppearanceLocalizer, LinearSearch, LocalizerParams, PanoramaDescriptor, StartPosePrior};
/// # use wayfix_estimation_traits::Pose2;
/// # use wayfix_gaussian_core::{Gaussian, GaussianMixture};
/// # let at = |x: f64| Gaussian::from_sigmas(Pose2::new(x, 0.0, 0.0), &Vector3::new(0.02, 0.02, 0.01));
/// let robot = |start| AppearanceLocalizer::<PanoramaDescriptor, LinearSearch<_>>::new(LocalizerParams::default(), start);
/// let docks = GaussianMixture::from_weights(vec![(0.3, at(1.0)?), (0.7, at(5.0)?)])?;
/// let among = robot(StartPosePrior::Among(docks))?;
/// assert_eq!(among.estimate().map(|pose| pose.mean().x()), Some(5.0)); // the heaviest
/// assert!(robot(StartPosePrior::Anywhere)?.estimate().is_none());
/// # Ok::<(), wayfix_appearance_cml::AppearanceMapError>(())
/// ```
#[derive(Clone, Debug, PartialEq)]
pub enum StartPosePrior {
    /// This pose, in the frame of the map.
    Known(Gaussian<Pose2<f64>>),
    /// One of several poses, as in a saved state.
    Among(GaussianMixture<Pose2<f64>>),
    /// Anywhere in the map.
    Anywhere,
}

impl StartPosePrior {
    /// The checked mixture, the heaviest component first; `None` for anywhere.
    pub(super) fn into_state(self) -> Result<Option<GaussianMixture<Pose2<f64>>>, AppearanceMapError> {
        let weighted = match self {
            Self::Anywhere => return Ok(None),
            Self::Among(places) => places.into_log_weighted(),
            Self::Known(pose) => vec![(0.0, pose)],
        };
        let checked = weighted.into_iter().map(|(log_weight, place)| {
            let (mean, covariance) = place.into_parts();
            Gaussian::new(mean, covariance).map(|place| (log_weight, place))
        });
        let mut checked = checked.collect::<Result<Vec<_>, _>>()?;
        checked.sort_by(|a, b| b.0.total_cmp(&a.0));
        Ok(Some(GaussianMixture::from_log_weights(checked)?))
    }
}
