use nalgebra::Vector2;
use rand::Rng;
use wayfix_estimation_traits::Pose2;
use wayfix_sensor_log::{DetectionTarget, TrueLandmark};

use super::super::ambient_light::AmbientLight;
use super::super::camera::OmniCameraParams;
use super::super::color::Rgb8;
use super::super::light::LightField;
use super::super::panel::{Material, Panel};
use super::super::texture::Texture;
use super::super::view::ViewRenderer;
use super::aisles::AisleGrid;
use crate::scenery::RgbPicture;
use crate::world::{SensorWorld, Wall};
use crate::{SimulationError, check};

/// Rooms with their furniture: the result of [`RetailStore`](crate::indoors::RetailStore) and [`Laboratory`](crate::indoors::Laboratory).
///
/// The origin is in the middle of the floor, x along its length.
#[derive(Clone, Debug, PartialEq)]
pub struct Building {
    pub(in crate::indoors) size: Vector2<f64>,
    pub(in crate::indoors) ceiling_m: f64,
    pub(in crate::indoors) floor: Rgb8,
    pub(in crate::indoors) ceiling: Rgb8,
    pub(in crate::indoors) panels: Vec<Panel>,
    pub(in crate::indoors) textures: Vec<Texture>,
    pub(in crate::indoors) light: LightField,
    pub(in crate::indoors) n_lamps: usize,
    pub(in crate::indoors) n_curtains: usize,
    pub(in crate::indoors) aisles: AisleGrid,
}

impl Building {
    /// Extent along x and y, metres.
    pub fn size_m(&self) -> Vector2<f64> {
        self.size
    }

    /// The drivable aisles.
    pub fn aisles(&self) -> &AisleGrid {
        &self.aisles
    }

    /// The view from `pose` in typical light, without people.
    /// # Errors
    /// Returns an error if the numbers do not make a camera, or the pose is not finite.
    ///
    /// ```
    /// use rand_chacha::{ChaCha8Rng, rand_core::SeedableRng};
    /// use wayfix_estimation_traits::Pose2;
    /// use wayfix_scene_sim::indoors::{Laboratory, OmniCameraParams};
    /// let mut rng = ChaCha8Rng::seed_from_u64(1);
    /// let lab = Laboratory::draw(&mut rng).building();
    /// let view = lab.render_view(&Pose2::new(0.0, -3.7, 0.0), OmniCameraParams::default(), &mut rng)?;
    /// assert_eq!((view.width, view.height), (120, 20));
    /// # Ok::<(), wayfix_scene_sim::SimulationError>(())
    /// ```
    pub fn render_view<R: Rng + ?Sized>(
        &self,
        pose: &Pose2<f64>,
        camera: OmniCameraParams,
        rng: &mut R,
    ) -> Result<RgbPicture, SimulationError> {
        check::finite("pose of the camera", pose.x() + pose.y() + pose.heading())?;
        let ambient_light = AmbientLight::nominal(self.n_lamps, self.n_curtains);
        Ok(ViewRenderer::new(camera)?.render_view(self, &ambient_light, &[], pose, rng))
    }

    /// Adds a panel with a texture between two heights.
    pub(in crate::indoors) fn put(
        &mut self,
        left: Vector2<f64>,
        right: Vector2<f64>,
        [bottom_m, top_m]: [f64; 2],
        texture: Texture,
    ) {
        self.panels.push(Panel {
            left,
            right,
            bottom_m,
            top_m,
            material: Material::Lit(self.textures.len()),
        });
        self.textures.push(texture);
    }
}

/// Its walls and fronts as a plan, for a laser or a map; it has no landmarks.
impl SensorWorld for Building {
    fn landmarks(&self) -> Vec<TrueLandmark> {
        Vec::new()
    }

    fn walls(&self) -> Vec<Wall> {
        self.panels.iter().map(|panel| Wall { from: panel.left, to: panel.right }).collect()
    }

    fn targets(&self, _seconds: f64) -> Vec<(DetectionTarget, Vector2<f64>)> {
        Vec::new()
    }
}
