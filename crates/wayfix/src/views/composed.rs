use wayfix_condensation::Picture;
use wayfix_scene_sim::scenery::{RgbPicture, Scenery, Visit};

use super::ViewsError;

/// A composed scene as it is learned, and as it looks on a visit.
///
/// # Errors
/// [`ViewsError::Scenery`] when the visit is no camera.
pub fn composed(scenery: &Scenery, visit: &Visit) -> Result<(Picture, Picture), ViewsError> {
    let learned = scenery.compose();
    let real = visit.picture_of(&learned, scenery.seed)?;
    let picture = |RgbPicture { width, height, rgb }| Picture::from_rgb(width, height, rgb);
    Ok((picture(learned)?, picture(real)?))
}
