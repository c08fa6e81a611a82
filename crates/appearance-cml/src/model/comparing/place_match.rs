use nalgebra::Vector3;
use wayfix_estimation_traits::{Manifold, Pose2};
use wayfix_gaussian_core::Gaussian;

use super::super::PlaceComponent;
use crate::ReferenceMatch;

/// A place whose reference matches the view, and the pose that it gives.
///
/// ```
/// # use nalgebra::Vector3;
/// # use wayfix_appearance_cml::{AppearanceMap, AppearanceMapParams, PanoramaDescriptor, ViewDifferenceSample};
/// # use wayfix_estimation_traits::Pose2;
/// # use wayfix_gaussian_core::Gaussian;
/// # let view = |re: i8, im: i8| PanoramaDescriptor::from_parts(0.01, 1, vec![3, re, im]);
/// # let place = Gaussian::from_sigmas(Pose2::new(1.0, 2.0, 0.0), &Vector3::new(0.1, 0.1, 0.1))?;
/// # let mut map: AppearanceMap<PanoramaDescriptor> = AppearanceMap::default();
/// # map.scale_mut().add_near(ViewDifferenceSample { lag: 0.25, distance: 0.1 });
/// map.teach(view(20, 0)?, &place)?;
/// // The robot is back and faces left: the first harmonic has turned by a quarter.
/// let matches = map.all_place_matches(&view(0, -20)?, &AppearanceMapParams::default());
/// assert!((matches[0].similarity - 1.0).abs() < 1e-9);
/// let pose = matches[0].gaussian.mean();
/// assert!(pose.x() == 1.0 && (pose.heading() - std::f64::consts::FRAC_PI_2).abs() < 1e-9);
/// # Ok::<(), wayfix_appearance_cml::AppearanceMapError>(())
/// ```
#[derive(Clone, Debug, PartialEq)]
pub struct PlaceMatch {
    /// The reference, and its difference from the view.
    pub matched: ReferenceMatch,
    /// Index of the place in the reference.
    pub place: usize,
    /// Weight of the place in the map, in [0, 1].
    pub weight: f64,
    /// The similarity $`S`$, in [0, 1].
    pub similarity: f64,
    /// The place, turned to the heading of the view.
    pub gaussian: Gaussian<Pose2<f64>>,
}

impl PlaceMatch {
    pub(in crate::model) fn new(
        matched: ReferenceMatch,
        (place, component): (usize, &PlaceComponent),
        similarity: f64,
    ) -> Self {
        Self {
            matched,
            place,
            weight: component.weight,
            similarity,
            gaussian: turned(&component.gaussian, matched.comparison.rotation),
        }
    }
}

/// The belief about a robot turned by `rotation`; the covariance in the world stays.
pub(in crate::model) fn turned(belief: &Gaussian<Pose2<f64>>, rotation: f64) -> Gaussian<Pose2<f64>> {
    let mean = belief.mean().retract(&Vector3::new(0.0, 0.0, rotation));
    let to_new_body = belief.mean().chart_jacobian(&mean);
    let covariance = to_new_body * belief.covariance() * to_new_body.transpose();
    Gaussian::from_parts_unchecked(mean, covariance)
}
