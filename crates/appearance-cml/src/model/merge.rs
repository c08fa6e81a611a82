use wayfix_gaussian_core::{GaussianError, moment_matched};

use super::{AppearanceMapParams, PlaceComponent};
use crate::{AppearanceMapError, separation_squared};

/// Merges the newest place into the nearest other within the gate. [Gross et al. 2005, Eq. 12]
pub(super) fn merge_places(
    places: &mut Vec<PlaceComponent>,
    params: &AppearanceMapParams,
    gate: f64,
) -> Result<(), AppearanceMapError> {
    let Some(newest) = places.pop() else { return Ok(()) };
    let mut nearest = None;
    let mut least = gate;
    for (index, place) in places.iter().enumerate() {
        let squared = separation_squared(&place.gaussian, &newest.gaussian)?;
        if squared < least {
            (nearest, least) = (Some(index), squared);
        }
    }
    match nearest {
        Some(index) => places[index] = merged(&places[index], &newest, params)?,
        None => places.push(newest),
    }
    Ok(())
}

/// One place of two: moments by normalized counts, counts and weights add. [Gross et al. 2005, Eqs. 13–14]
pub(super) fn merged(
    a: &PlaceComponent,
    b: &PlaceComponent,
    params: &AppearanceMapParams,
) -> Result<PlaceComponent, AppearanceMapError> {
    let gaussian = moment_matched(&[a.count, b.count], &[a.gaussian.clone(), b.gaussian.clone()])
        .map_err(GaussianError::from)?;
    Ok(PlaceComponent {
        weight: (a.weight + b.weight).min(1.0),
        count: (a.count + b.count).min(params.max_effective_observation_count),
        gaussian,
    })
}
