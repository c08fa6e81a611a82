use nalgebra::Vector3;
use wayfix_gaussian_core::PooledGroupEstimate;

use super::{LightingPriorError, PooledPixelVariance, TrainingVenue};
use crate::ColorMeans;

/// A venue as a group of observations of its colours; colours not in an image are missing.
pub(super) fn evidence(
    venue: &TrainingVenue,
    n_colors: usize,
    mean_color_variance: &Vector3<f64>,
) -> Result<PooledGroupEstimate, LightingPriorError> {
    let mut group = PooledGroupEstimate::new(3 * n_colors);
    for (color, mean) in venue.images.iter().flat_map(ColorMeans::seen) {
        let first = 3 * usize::from(color.0);
        group.observe(&[first, first + 1, first + 2], mean.as_slice(), mean_color_variance.as_slice())?;
    }
    Ok(group)
}

/// Variance of an image's mean of a colour about its venue's mean of it, pooled over colours and venues, (Y, U, V).
pub(super) fn pooled_mean_color_variance(
    venues: &[TrainingVenue],
    n_colors: usize,
) -> Result<Vector3<f64>, LightingPriorError> {
    let mut scatter = Vector3::zeros();
    let mut degrees_of_freedom = 0.0;
    for venue in venues {
        for color in 0..n_colors {
            let of_color = |(id, mean): (wayfix_color_map::ColorId, Vector3<f64>)| {
                (usize::from(id.0) == color).then_some(mean)
            };
            let means: Vec<Vector3<f64>> =
                venue.images.iter().flat_map(ColorMeans::seen).filter_map(of_color).collect();
            let center = means.iter().sum::<Vector3<f64>>() / (means.len().max(1) as f64);
            for mean in &means {
                let deviation = mean - center;
                scatter += deviation.component_mul(&deviation);
            }
            degrees_of_freedom += means.len().saturating_sub(1) as f64;
        }
    }
    let variance = scatter / degrees_of_freedom;
    if variance.iter().all(|v| *v > 0.0 && v.is_finite()) {
        Ok(variance)
    } else {
        Err(LightingPriorError::UnknownScatter)
    }
}

/// Variance of pixels, pooled over the venues that recorded it; `otherwise` if none did.
pub(super) fn pooled_pixel_color_variance(
    venues: &[TrainingVenue],
    otherwise: &Vector3<f64>,
) -> Vector3<f64> {
    let mut scatter = Vector3::zeros();
    let mut pooled = 0.0;
    for PooledPixelVariance { variances, degrees_of_freedom } in
        venues.iter().filter_map(|venue| venue.pixels)
    {
        scatter += variances * degrees_of_freedom;
        pooled += degrees_of_freedom;
    }
    let variance = scatter / pooled;
    if variance.iter().all(|v| *v > 0.0 && v.is_finite()) { variance } else { *otherwise }
}
