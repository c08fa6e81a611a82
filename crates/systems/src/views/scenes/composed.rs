use wayfix_condensation::Picture;
use wayfix_scene_sim::scenery::{ImagingConditions, RgbPicture, Scenery};

use super::super::ViewsError;

/// A composed scene as it is learned, and as it looks on a later visit.
///
/// # Errors
/// Returns [`ViewsError::Scenery`] if the visit has an invalid camera.
pub fn composed_scene_pair(
    scenery: &Scenery,
    imaging_conditions: &ImagingConditions,
) -> Result<(Picture, Picture), ViewsError> {
    let learned = scenery.compose();
    let real = imaging_conditions.picture_of(&learned, scenery.seed)?;
    let picture = |RgbPicture { width, height, rgb }| Picture::from_rgb(width, height, rgb);
    Ok((picture(learned)?, picture(real)?))
}
