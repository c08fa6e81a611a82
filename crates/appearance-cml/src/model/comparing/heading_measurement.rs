use super::super::interpolate::{KERNEL_WIDTH, groups, nearest_of, shares, turn_of};
use super::super::{PlaceMatch, ViewDistanceScale};
use crate::AppearanceMapError;

/// Which way the robot looks, as the references say that lie around it.
///
/// A view says which way it looks for much longer than it says where it is from: shelves run along the aisle whatever stands in them. In stores of which
/// 0.4 and 0.8 was rearranged the best rotation errs by 2° (median 0.8°) for views at 0.6 to 0.8 from all references around, and by 3° (1°) at 0.8 to
/// 0.9, where nothing tells any longer which of them is the nearest in metres.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct HeadingMeasurement {
    /// In the frame of the map, rad.
    pub(crate) heading: f64,
    /// Variance of the comparison, rad². Its errors last for some views, and it is as much greater.
    pub(crate) comparison_variance: f64,
    /// Variance of the headings that the references have in the map, rad².
    pub(crate) map_variance: f64,
}

/// σ of the comparison, as a multiple of that beside a recognized place: in one place of twenty the rotation errs by 5° and more for as long as the same shelf is
/// in sight. With the same σ drives past rearranged shelves err more than without any compass.
const WIDER: f64 = 2.0;

impl HeadingMeasurement {
    /// From the most similar sighting and its neighbours; `None` without any.
    ///
    /// # Errors
    /// When a place is not finite.
    pub(crate) fn of(
        place_matches: &[PlaceMatch],
        scale: &ViewDistanceScale,
    ) -> Result<Option<Self>, AppearanceMapError> {
        let groups = groups(place_matches, scale);
        let Some(group) = groups.first().map(|group| nearest_of(group)) else { return Ok(None) };
        let shares = shares(group, KERNEL_WIDTH * scale.step_distance());
        let (heading, comparison_variance) = turn_of(group, &shares, scale)?;
        let map_variance =
            group.iter().zip(&shares).map(|(s, share)| s.gaussian.covariance()[(2, 2)] * share).sum();
        let comparison_variance = WIDER * WIDER * comparison_variance;
        Ok(Some(Self { heading, comparison_variance, map_variance }))
    }
}
