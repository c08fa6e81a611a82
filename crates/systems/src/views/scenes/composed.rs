use wayfix_condensation::RgbImage;
use wayfix_scene_sim::scenery::{ImagingConditions, RgbPicture, Scenery};

use super::super::ViewsError;

/// A composed scene when it is learned, and on a later visit.
///
/// # Errors
/// Returns [`ViewsError::Scenery`] if the visit has an invalid camera.
pub fn composed_scene_pair(
    scenery: &Scenery,
    imaging_conditions: &ImagingConditions,
) -> Result<(RgbImage, RgbImage), ViewsError> {
    let learned = scenery.compose();
    let real = imaging_conditions.picture_of(&learned, scenery.seed)?;
    let picture = |RgbPicture { width, height, rgb }| {
        RgbImage::from_raw(width as u32, height as u32, rgb).expect("invariant: 3 bytes a pixel")
    };
    Ok((picture(learned), picture(real)))
}
