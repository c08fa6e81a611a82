use wayfix_estimation_traits::Pose2;
use wayfix_gaussian_core::{Gaussian, check_covariance};

use crate::{AppearanceMapError, check};

/// One place where a reference view was seen. [Gross et al. 2005, Eq. 10]
#[derive(Clone, Debug, PartialEq)]
pub struct PlaceComponent {
    /// How certain and relevant it is, in [0, 1]; weights of a reference need not add up to one.
    pub weight: f64,
    /// How many observations it is made of, each counted by its share; positive.
    pub count: f64,
    /// Pose of a robot that sees exactly the reference view, unturned.
    pub gaussian: Gaussian<Pose2<f64>>,
}

/// Where one reference view was seen.
#[derive(Clone, Debug, PartialEq, Default)]
pub struct ReferenceView {
    /// The places; a reference without any is removed.
    pub places: Vec<PlaceComponent>,
}

impl ReferenceView {
    /// $`\sum_j w_{ij}`$: how much the reference matters.
    pub fn importance(&self) -> f64 {
        self.places.iter().map(|place| place.weight).sum()
    }

    /// Whether the numbers have a meaning.
    ///
    /// # Errors
    /// Names the first that has none.
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
