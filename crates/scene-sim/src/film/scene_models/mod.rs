//! The five stories, a file each.

mod beetle;
mod circles;
mod head;
mod rectangle;
mod snail;

use super::{Film, Silhouette};
use crate::random::Streams;
use crate::scenery::canvas::{Canvas, Color};

/// What is before the camera at one moment.
pub(super) struct Scene {
    /// Linear radiance.
    pub(super) canvas: Canvas,
    pub(super) target: Silhouette,
    pub(super) distractor: Silhouette,
}

/// A story.
pub(super) trait SceneModel {
    /// The scene, its target so many pixels to the right of where its path leads.
    fn render(&self, seconds: f64, aside: f64) -> Scene;

    /// The light that falls on what passes before the target.
    fn light(&self, seconds: f64) -> Color;
}

/// Sets the stage.
pub(super) fn scene_model(film: &Film, streams: &mut Streams) -> Box<dyn SceneModel> {
    match film.name {
        "circles" => Box::new(circles::Circles::new(streams)),
        "rectangle" => Box::new(rectangle::Rectangle::new(streams)),
        "beetle" => Box::new(beetle::Beetle::new(streams)),
        "snail" => Box::new(snail::Snail::new(streams)),
        _ => Box::new(head::Head::new(streams)),
    }
}
