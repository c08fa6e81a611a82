use nalgebra::Vector3;
use wayfix_estimation_traits::{Manifold, Pose2};
use wayfix_gaussian_core::Gaussian;

use super::super::PlaceComponent;
use crate::ReferenceMatch;

/// A place whose reference looks like the view: what it says of the pose, and how strongly.
#[derive(Clone, Debug, PartialEq)]
pub struct PlaceMatch {
    /// Which reference, and by how much it differs.
    pub matched: ReferenceMatch,
    /// Which of its places.
    pub place: usize,
    /// Weight of the place in the map, in [0, 1].
    pub weight: f64,
    /// How much it speaks for its place, in [0, 1]: $`S`$.
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

/// A belief about a robot that is turned by `rotation`, its covariance as it was in the world.
pub(in crate::model) fn turned(belief: &Gaussian<Pose2<f64>>, rotation: f64) -> Gaussian<Pose2<f64>> {
    let mean = belief.mean().retract(&Vector3::new(0.0, 0.0, rotation));
    let to_new_body = belief.mean().chart_jacobian(&mean);
    let covariance = to_new_body * belief.covariance() * to_new_body.transpose();
    Gaussian::from_parts_unchecked(mean, covariance)
}
