use wayfix_estimation_traits::Pose2;
use wayfix_gaussian_core::{Gaussian, check_covariance};

use crate::{AppearanceMapError, check};

/// One place where a reference view was seen. [Gross et al. 2005, Eq. 10]
///
/// ```
/// use nalgebra::Vector3;
/// use wayfix_appearance_cml::{PlaceComponent, ReferenceView};
/// use wayfix_estimation_traits::Pose2;
/// use wayfix_gaussian_core::Gaussian;
/// let gaussian = Gaussian::from_sigmas(Pose2::new(1.0, 0.0, 0.0), &Vector3::new(0.1, 0.1, 0.1))?;
/// let reference = ReferenceView { places: vec![PlaceComponent { weight: 0.3, count: 1.0, gaussian }] };
/// assert!(reference.validate().is_ok() && reference.importance() == 0.3);
/// # Ok::<(), wayfix_appearance_cml::AppearanceMapError>(())
/// ```
#[derive(Clone, Debug, PartialEq)]
pub struct PlaceComponent {
    /// Certainty and relevance, in [0, 1]; the weights of a reference need not add up to one.
    pub weight: f64,
    /// Number of observations, each counted by its share; positive.
    pub count: f64,
    /// Pose of a robot that sees exactly the reference view, unturned.
    pub gaussian: Gaussian<Pose2<f64>>,
}

/// The places of one reference view.
///
/// ```
/// # use nalgebra::Vector3;
/// # use wayfix_appearance_cml::{PlaceComponent, ReferenceView};
/// # use wayfix_estimation_traits::Pose2;
/// # use wayfix_gaussian_core::Gaussian;
/// # let gaussian = Gaussian::from_sigmas(Pose2::new(1.0, 0.0, 0.0), &Vector3::new(0.1, 0.1, 0.1))?;
/// let place = |weight: f64| PlaceComponent { weight, count: 1.0, gaussian: gaussian.clone() };
/// // Two shelves that look alike: the weights of their places need not add up to one.
/// let reference = ReferenceView { places: vec![place(0.75), place(0.5)] };
/// assert!(reference.validate().is_ok() && reference.importance() == 1.25);
/// assert!(ReferenceView { places: vec![place(1.5)] }.validate().is_err());
/// # Ok::<(), wayfix_appearance_cml::AppearanceMapError>(())
/// ```
#[derive(Clone, Debug, PartialEq, Default)]
pub struct ReferenceView {
    /// The places; a reference without any is removed.
    pub places: Vec<PlaceComponent>,
}

impl ReferenceView {
    /// The importance of the reference, $`\sum_j w_{ij}`$.
    pub fn importance(&self) -> f64 {
        self.places.iter().map(|place| place.weight).sum()
    }

    /// Checks the ranges.
    ///
    /// # Errors
    /// Returns an error that names the first number outside its range.
    pub fn validate(&self) -> Result<(), AppearanceMapError> {
        for place in &self.places {
            check::share("weight of a place", place.weight)?;
            check::positive("count of a place", place.count)?;
            if !place.gaussian.mean().is_finite() {
                return Err(AppearanceMapError::NotFinite { what: "place of a reference" });
            }
            check_covariance("place's", place.gaussian.covariance())?;
        }
        Ok(())
    }
}
