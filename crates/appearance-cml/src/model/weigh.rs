use nalgebra::{Matrix3, Vector2, Vector3};
use wayfix_estimation_traits::Pose2;
use wayfix_gaussian_core::Gaussian;

use super::comparing::place_match::turned;
use super::{
    AppearanceMapParams, ForgettingUncertainty, PlaceComponent, PlaceUpdateRule, ViewDifferenceModel,
};
use crate::{AppearanceMapError, ReferenceMatch, separation_squared, similarity};

/// The weight of a place whose reference matches: it grows if the robot is there and falls if the robot is elsewhere.
///
/// $`w ← β S + (1 - β S) w`$ or $`w ← (1 - β S) w`$. [Gross et al. 2005, Eqs. 15–17]
pub(super) fn weight_when_seen(
    place: &PlaceComponent,
    matched: &ReferenceMatch,
    pose: &Gaussian<Pose2<f64>>,
    (limit, gate): (f64, f64),
    (scale, params): (&ViewDifferenceModel, &AppearanceMapParams),
) -> Result<f64, AppearanceMapError> {
    let gain = params.weight_learning_rate * similarity(matched.comparison.distance, limit);
    let seen_from = turned(&place.gaussian, matched.comparison.rotation);
    let expected = match params.place_update {
        PlaceUpdateRule::Pose => seen_from,
        // The distance of a matching view from its reference follows from their difference.
        PlaceUpdateRule::Residual => widened(&seen_from, scale.to_meters(matched.comparison.distance)),
    };
    let agrees = separation_squared(pose, &expected)? <= gate;
    Ok((1.0 - gain) * place.weight + if agrees { gain } else { 0.0 })
}

/// The weight of a place of the robot whose reference does not match. [Gross et al. 2005, Eqs. 18–19]
///
/// $`w ← (1 - b) w`$, $`b = β_{for} \max(1 - d/d^{for}, 0)\, d^{gain}/σ`$, clamped to [0, 1], with the distance $`d`$ in the plane and the
/// [uncertainty](ForgettingUncertainty) $`σ`$. $`d^{for}`$ is the match radius, beyond which no match is expected; $`d^{gain}`$ is two steps: a pose
/// that certain is next to the reference.
pub(super) fn weight_when_missed(
    place: &PlaceComponent,
    pose: &Gaussian<Pose2<f64>>,
    radius: f64,
    (scale, params): (&ViewDifferenceModel, &AppearanceMapParams),
) -> f64 {
    let distance = (pose.mean().translation - place.gaussian.mean().translation).norm();
    let nearness = (1.0 - distance / radius).max(0.0);
    let gain = 2.0 * scale.step();
    let certainty = match params.forgetting_uncertainty_kind {
        ForgettingUncertainty::Pose => gain / map_sigmas(pose).sum(),
        ForgettingUncertainty::AgainstPlace => {
            let own = pose.sigmas().xy().norm_squared() - place.gaussian.sigmas().xy().norm_squared();
            (gain / (2.0 * own.max(0.0)).sqrt()).min(1.0)
        }
    };
    let loss = params.forgetting_rate * nearness * certainty;
    // A radius of 0 changes no weight.
    if loss.is_finite() { (1.0 - loss.clamp(0.0, 1.0)) * place.weight } else { place.weight }
}

/// $`σ_x`$ and $`σ_y`$ along the axes of the map.
fn map_sigmas(pose: &Gaussian<Pose2<f64>>) -> Vector2<f64> {
    let to_map = pose.mean().rotation_matrix();
    let covariance = to_map * pose.covariance().fixed_view::<2, 2>(0, 0) * to_map.transpose();
    covariance.diagonal().map(f64::sqrt)
}

fn widened(belief: &Gaussian<Pose2<f64>>, metres: f64) -> Gaussian<Pose2<f64>> {
    let variance = metres * metres;
    let more = Matrix3::from_diagonal(&Vector3::new(variance, variance, 0.0));
    Gaussian::from_parts_unchecked(*belief.mean(), belief.covariance() + more)
}
