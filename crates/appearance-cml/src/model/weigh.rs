use nalgebra::Matrix3;
use wayfix_estimation_traits::Pose2;
use wayfix_gaussian_core::Gaussian;

use super::comparing::place_match::turned;
use super::{
    AppearanceMapParams, ForgettingParams, ForgettingUncertainty, PlaceComponent, PlaceUpdateRule,
    ViewDistanceScale,
};
use crate::{AppearanceMapError, ReferenceMatch, separation_squared, similarity};

/// The weight of a place whose reference looks like the view: it grows when the robot is there and fades when the robot is elsewhere.
///
/// $`w ← β S + (1 - β S) w`$ or $`w ← (1 - β S) w`$. [Gross et al. 2005, Eqs. 15-17]
pub(super) fn weight_when_seen(
    place: &PlaceComponent,
    matched: &ReferenceMatch,
    pose: &Gaussian<Pose2<f64>>,
    (limit, scale, params): (f64, &ViewDistanceScale, &AppearanceMapParams),
) -> Result<f64, AppearanceMapError> {
    let gain = params.learning_rate * similarity(matched.comparison.distance, limit);
    let seen_from = turned(&place.gaussian, matched.comparison.rotation);
    let expected = match params.place_update {
        PlaceUpdateRule::Pose => seen_from,
        // A view that is like its reference is not from the same spot: how far off it may be is known.
        PlaceUpdateRule::Residual => widened(&seen_from, scale.to_meters(matched.comparison.distance)),
    };
    let agrees = separation_squared(pose, &expected)? <= params.place_gate;
    Ok((1.0 - gain) * place.weight + if agrees { gain } else { 0.0 })
}

/// The weight of a place where the robot is and whose reference it does not see. [Gross et al. 2005, Eqs. 18-19]
///
/// $`w ← (1 - b) w`$, $`b = β_{for} \max(1 - d/d^{for}, 0)\, d^{gain}/σ`$ with the distance $`d`$ in the plane, clamped to [0, 1], and the
/// [uncertainty](ForgettingUncertainty) $`σ`$.
pub(super) fn weight_when_missed(
    place: &PlaceComponent,
    pose: &Gaussian<Pose2<f64>>,
    radius: f64,
    (scale, params): (&ViewDistanceScale, &ForgettingParams),
) -> f64 {
    let distance = (pose.mean().translation - place.gaussian.mean().translation).norm();
    let nearness = (1.0 - distance / radius).max(0.0);
    let gain = params.full_rate_sigma.unwrap_or_else(|| 2.0 * scale.step());
    let sharpness = gain / uncertainty(place, pose, params.uncertainty_measure);
    let loss = params.rate * nearness * sharpness.min(1.0);
    // A radius of nothing forgets nothing.
    if loss.is_finite() { (1.0 - loss.clamp(0.0, 1.0)) * place.weight } else { place.weight }
}

fn uncertainty(place: &PlaceComponent, pose: &Gaussian<Pose2<f64>>, of: ForgettingUncertainty) -> f64 {
    let sigmas = |gaussian: &Gaussian<Pose2<f64>>| gaussian.sigmas().xy();
    match of {
        ForgettingUncertainty::Pose => sigmas(pose).sum(),
        ForgettingUncertainty::AgainstPlace => {
            let own = sigmas(pose).norm_squared() - sigmas(&place.gaussian).norm_squared();
            (2.0 * own.max(0.0)).sqrt()
        }
    }
}

fn widened(belief: &Gaussian<Pose2<f64>>, metres: f64) -> Gaussian<Pose2<f64>> {
    let variance = metres * metres;
    let more = Matrix3::from_diagonal(&nalgebra::Vector3::new(variance, variance, 0.0));
    Gaussian::from_parts_unchecked(*belief.mean(), belief.covariance() + more)
}
