use wayfix_estimation_traits::Pose2;
use wayfix_gaussian_core::{Gaussian, GaussianMixture};

use crate::AppearanceMapError;

/// Where the robot is when it is switched on.
#[derive(Clone, Debug, PartialEq)]
pub enum Start {
    /// There, in the frame of the map.
    Known(Gaussian<Pose2<f64>>),
    /// In one of several places, as a state that was saved says.
    Among(GaussianMixture<Pose2<f64>>),
    /// Anywhere in the map.
    Anywhere,
}

impl Start {
    pub(super) fn into_state(self) -> Result<Option<GaussianMixture<Pose2<f64>>>, AppearanceMapError> {
        match self {
            Self::Anywhere => Ok(None),
            Self::Among(places) => {
                let checked = places.into_log_weighted().into_iter().map(|(log_weight, place)| {
                    let (mean, covariance) = place.into_parts();
                    Gaussian::new(mean, covariance).map(|place| (log_weight, place))
                });
                let mut checked = checked.collect::<Result<Vec<_>, _>>()?;
                checked.sort_by(|a, b| b.0.total_cmp(&a.0));
                Ok(Some(GaussianMixture::from_log_weights(checked)?))
            }
            Self::Known(pose) => {
                let (mean, covariance) = pose.into_parts();
                let checked = Gaussian::new(mean, covariance)?;
                Ok(Some(GaussianMixture::from_weights(vec![(1.0, checked)])?))
            }
        }
    }
}
