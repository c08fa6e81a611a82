//! The five stories, a file each.

mod beetle;
mod circles;
mod head;
mod rectangle;
mod snail;

use super::{Silhouette, SyntheticFilm};
use crate::random::RandomStreams;
use crate::scenery::canvas::{Canvas, Color};

/// The scene before the camera at one moment.
pub(super) struct LeagueScene {
    /// Linear radiance.
    pub(super) canvas: Canvas,
    pub(super) target: Silhouette,
    pub(super) distractor: Silhouette,
}

/// A story.
pub(super) trait SceneModel {
    /// Renders the scene, with its target displaced by this many pixels to the right of its path.
    fn render(&self, seconds: f64, aside: f64) -> LeagueScene;

    /// The light on the occluder.
    fn light(&self, seconds: f64) -> Color;
}

/// Sets the stage.
pub(super) fn scene_model(film: &SyntheticFilm, streams: &mut RandomStreams) -> Box<dyn SceneModel> {
    match film.name {
        "circles" => Box::new(circles::Circles::new(streams)),
        "rectangle" => Box::new(rectangle::Rectangle::new(streams)),
        "beetle" => Box::new(beetle::Beetle::new(streams)),
        "snail" => Box::new(snail::Snail::new(streams)),
        _ => Box::new(head::Head::new(streams)),
    }
}
