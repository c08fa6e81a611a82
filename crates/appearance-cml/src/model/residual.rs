use nalgebra::Vector2;
use wayfix_estimation_traits::Pose2;
use wayfix_gaussian_core::Gaussian;

use super::comparing::place_match::turned;
use super::merge::merged;
use super::{AppearanceMapParams, PlaceComponent};
use crate::{AppearanceMapError, ReferenceMatch};

/// The pose of the robot minus the pose that the references give, in the frame of the map.
pub(super) struct Residual {
    pub(super) translation: Vector2<f64>,
    pub(super) turn: f64,
}

impl Residual {
    /// Merges the place, moved by the residual, into the place.
    pub(super) fn correct(
        &self,
        place: &mut PlaceComponent,
        matched: &ReferenceMatch,
        count: f64,
        (pose, params): (&Gaussian<Pose2<f64>>, &AppearanceMapParams),
    ) -> Result<(), AppearanceMapError> {
        let old = place.gaussian.mean();
        let seen_from = turned(pose, -matched.comparison.rotation);
        let corrected =
            Pose2::new(old.x() + self.translation.x, old.y() + self.translation.y, old.heading() + self.turn);
        let covariance = seen_from.in_chart_at(&corrected)?.covariance().to_owned();
        let observed = PlaceComponent {
            weight: 0.0,
            count,
            gaussian: Gaussian::from_parts_unchecked(corrected, covariance),
        };
        *place = merged(place, &observed, params)?;
        Ok(())
    }
}
