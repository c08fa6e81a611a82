use nalgebra::Vector2;
use wayfix_sensor_log::{Target, TrueLandmark};

use super::aisles::Aisles;
use super::color::Rgb8;
use super::light::LightField;
use super::panel::{Panel, Skin};
use super::texture::Texture;
use crate::world::{Wall, World};

/// Rooms with everything that stands in them, ready to be looked at: what [`Store`](super::Store) and [`Lab`](super::Lab) build.
///
/// The origin is in the middle of the floor, x along its length.
#[derive(Clone, Debug, PartialEq)]
pub struct Building {
    pub(super) size: Vector2<f64>,
    pub(super) ceiling_m: f64,
    pub(super) floor: Rgb8,
    pub(super) ceiling: Rgb8,
    pub(super) panels: Vec<Panel>,
    pub(super) textures: Vec<Texture>,
    pub(super) light: LightField,
    pub(super) n_lamps: usize,
    pub(super) n_curtains: usize,
    pub(super) aisles: Aisles,
}

impl Building {
    /// Extent along x and y, metres.
    pub fn size_m(&self) -> Vector2<f64> {
        self.size
    }

    /// Where one can drive.
    pub fn aisles(&self) -> &Aisles {
        &self.aisles
    }

    /// Puts up a panel with a texture of its own between two heights.
    pub(super) fn put(
        &mut self,
        left: Vector2<f64>,
        right: Vector2<f64>,
        [bottom_m, top_m]: [f64; 2],
        texture: Texture,
    ) {
        self.panels.push(Panel { left, right, bottom_m, top_m, skin: Skin::Lit(self.textures.len()) });
        self.textures.push(texture);
    }
}

/// Its walls and fronts as a plan, for a laser or a map; there are no landmarks.
impl World for Building {
    fn landmarks(&self) -> Vec<TrueLandmark> {
        Vec::new()
    }

    fn walls(&self) -> Vec<Wall> {
        self.panels.iter().map(|panel| Wall { from: panel.left, to: panel.right }).collect()
    }

    fn targets(&self, _seconds: f64) -> Vec<(Target, Vector2<f64>)> {
        Vec::new()
    }
}
