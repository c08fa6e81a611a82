use std::f64::consts::{FRAC_PI_3, PI};

use nalgebra::{Matrix2, Vector2};
use wayfix_estimation_traits::Pose2;
use wayfix_gaussian_core::{Gaussian, GaussianMixture, check_covariance};

use crate::{AppearanceMapError, PoseHypothesis};

/// A source of pose hypotheses: GPS, Wi-Fi, a laser, a person who points at the map. [Gross et al. 2005, Fig. 2]
///
/// **Law**: weights are probabilities in [0, 1]; 1 means that no other pose is possible.
///
/// ```
/// # use nalgebra::Vector3;
/// # use wayfix_appearance_cml::{AppearanceLocalizer, AppearanceMapError, LinearSearch, LocalizerParams, PanoramaDescriptor};
/// # use wayfix_appearance_cml::{PoseHypothesis, PoseHypothesisSource, StartPosePrior};
/// # use wayfix_estimation_traits::Pose2;
/// # use wayfix_gaussian_core::{Gaussian, GaussianMixture};
/// /// A contact of the charging dock: the robot is there with probability 0.99.
/// struct Docked(Gaussian<Pose2<f64>>);
/// impl PoseHypothesisSource for Docked {
///     fn hypotheses(&self, _: Option<&GaussianMixture<Pose2<f64>>>) -> Result<Vec<PoseHypothesis>, AppearanceMapError> {
///         Ok(vec![PoseHypothesis { weight: 0.99, gaussian: self.0.clone(), independent: 1.0 }])
///     }
/// }
/// # let dock = Docked(Gaussian::from_sigmas(Pose2::new(3.0, 1.0, 0.0), &Vector3::new(0.02, 0.02, 0.01))?);
/// # let mut robot = AppearanceLocalizer::<PanoramaDescriptor, LinearSearch<_>>::new(LocalizerParams::default(), StartPosePrior::Anywhere)?;
/// # let view = PanoramaDescriptor::from_parts(0.01, 1, vec![3, 20, 0])?;
/// let outcome = robot.update_with(view, &[&dock])?; // anywhere before, in an empty map
/// assert_eq!(outcome.estimate.map(|pose| pose.mean().x()), Some(3.0));
/// # Ok::<(), wayfix_appearance_cml::AppearanceMapError>(())
/// ```
pub trait PoseHypothesisSource {
    /// The hypotheses of the source at this time; the list may be empty.
    ///
    /// `predicted` is the belief after the odometry prediction, `None` before the first; a source that measures only a part of the pose takes
    /// the rest from it.
    ///
    /// # Errors
    /// Returns an [`AppearanceMapError`] if the measurement is invalid; the localizer then keeps its state.
    fn hypotheses(
        &self,
        predicted: Option<&GaussianMixture<Pose2<f64>>>,
    ) -> Result<Vec<PoseHypothesis>, AppearanceMapError>;
}

/// A measured position without a heading, such as a GPS fix.
///
/// ```
/// use nalgebra::{Matrix2, Vector2};
/// use wayfix_appearance_cml::{PoseHypothesisSource, PositionFix};
/// let fix = PositionFix { position: Vector2::new(3.0, 4.0), covariance: Matrix2::identity(), weight: 0.9 };
/// let hypotheses = fix.hypotheses(None)?;
/// assert_eq!((hypotheses[0].gaussian.mean().x(), hypotheses[0].independent), (3.0, 1.0));
/// # Ok::<(), wayfix_appearance_cml::AppearanceMapError>(())
/// ```
#[derive(Clone, Debug, PartialEq)]
pub struct PositionFix {
    /// In the frame of the map, m.
    pub position: Vector2<f64>,
    /// In the frame of the map, m².
    pub covariance: Matrix2<f64>,
    /// How much the fix is trusted, in [0, 1].
    pub weight: f64,
}

/// Variance of an unknown heading: that of a uniform one, $`π^2/3`$, rad².
const UNKNOWN_HEADING: f64 = PI * FRAC_PI_3;

impl PoseHypothesisSource for PositionFix {
    /// One hypothesis for each predicted heading, so that the axes of the body frames agree; one with heading 0 without a prediction.
    fn hypotheses(
        &self,
        predicted: Option<&GaussianMixture<Pose2<f64>>>,
    ) -> Result<Vec<PoseHypothesis>, AppearanceMapError> {
        check_covariance("position fix's", &self.covariance)?;
        crate::check::share("weight of a position fix", self.weight)?;
        let facing = |heading: f64| -> Result<PoseHypothesis, AppearanceMapError> {
            let mean = Pose2::new(self.position.x, self.position.y, heading);
            let to_body = mean.rotation_matrix().transpose();
            let mut covariance = (to_body * self.covariance * to_body.transpose()).to_homogeneous();
            covariance[(2, 2)] = UNKNOWN_HEADING;
            Ok(PoseHypothesis {
                weight: self.weight,
                gaussian: Gaussian::new(mean, covariance)?,
                independent: 1.0,
            })
        };
        match predicted {
            None => Ok(vec![facing(0.0)?]),
            Some(mixture) => mixture.components().iter().map(|c| facing(c.mean().heading())).collect(),
        }
    }
}
