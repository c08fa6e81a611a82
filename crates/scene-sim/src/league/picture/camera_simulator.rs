use rand::Rng;
use wayfix_estimation_traits::Pose3;

use super::camera::CameraParams;
use super::exposure::Exposure;
use super::image_pipeline::ImagePipeline;
use super::scene::LeagueScene;
use crate::SimulationError;
use crate::league::{LinearRgb, yuv};

/// Takes pictures with one camera.
///
/// ```
/// use rand_chacha::{ChaCha8Rng, rand_core::SeedableRng};
/// use wayfix_estimation_traits::{Pose3, nalgebra::Vector3};
/// use wayfix_scene_sim::league::{CameraParams, HallBackdrop, LampLight, CameraSimulator, LinearRgb, LeagueScene, SceneSurface, field_map};
/// use wayfix_scene_sim::space;
///
/// let light = LampLight { ambient: LinearRgb::repeat(0.8), ..LampLight::default() };
/// let paints = [LinearRgb::new(0.1, 0.4, 0.1); 5];
/// let surfaces = SceneSurface::of_map(&field_map()?);
/// let scene = LeagueScene { surfaces, paints: &paints, light: &light, backdrop: &HallBackdrop::default() };
/// let pose = Pose3 { translation: Vector3::new(0.0, 0.0, 0.25), rotation: space::pitch(0.3) };
/// let mut camera_simulator = CameraSimulator::new(CameraParams::ers7()?)?;
/// let picture = camera_simulator.take(&scene, [&pose, &pose], &LinearRgb::repeat(1.0), &mut ChaCha8Rng::seed_from_u64(1));
/// assert_eq!(picture.rgb.len(), 208 * 160 * 3);
/// assert!(picture.labels.iter().filter(|&&label| label == 1).count() > 5000, "much of it is carpet");
/// # Ok::<(), wayfix_scene_sim::SimulationError>(())
/// ```
pub struct CameraSimulator {
    exposure: Exposure,
    image_pipeline: ImagePipeline,
    params: CameraParams,
}

/// A picture and the truth about it.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct LeaguePicture {
    /// Pixels across.
    pub width: u32,
    /// Pixels down.
    pub height: u32,
    /// Red, green, blue, row by row.
    pub rgb: Vec<u8>,
    /// For each pixel the map colour's [`ColorId`](wayfix_color_map::ColorId) plus 1, or 0.
    ///
    /// 0 is what no map lists (backdrop, robots, ball, legs) and what is mixed: a pixel has a label only where all light that falls on it
    /// during the whole exposure comes from one map colour. Rays pass through a square 1.2 pixels wide, four per pixel and spread over the
    /// exposure. Chroma that is shared with a neighbour does not count as mixed.
    pub labels: Vec<u8>,
}

impl LeaguePicture {
    /// Y, U, V of each pixel: BT.601 in full range, U and V about 0, not rounded.
    pub fn yuv(&self) -> impl Iterator<Item = LinearRgb> {
        let pixels = self.rgb.chunks_exact(3);
        pixels.map(|rgb| yuv::from_rgb(&LinearRgb::from_iterator(rgb.iter().map(|&byte| f64::from(byte)))))
    }
}

impl CameraSimulator {
    /// With this camera.
    ///
    /// # Errors
    /// Returns [`SimulationError::Parameter`] or [`SimulationError::TooMany`] if a parameter is out of range.
    pub fn new(params: CameraParams) -> Result<Self, SimulationError> {
        params.validate()?;
        Ok(Self {
            exposure: Exposure::new(params.camera),
            image_pipeline: ImagePipeline::new(params),
            params,
        })
    }

    /// A picture: the camera (x along the optical axis) moves from the first pose to the second while the shutter is open, and
    /// `balance` multiplies its gains.
    pub fn take<R: Rng + ?Sized>(
        &mut self,
        scene: &LeagueScene<'_>,
        [opening, closing]: [&Pose3<f64>; 2],
        balance: &LinearRgb,
        rng: &mut R,
    ) -> LeaguePicture {
        self.exposure.take(scene, opening, closing);
        LeaguePicture {
            width: self.params.camera.width(),
            height: self.params.camera.height(),
            rgb: self.image_pipeline.process(&self.exposure.light, balance, rng),
            labels: self.exposure.labels.clone(),
        }
    }

    /// The camera.
    pub fn params(&self) -> &CameraParams {
        &self.params
    }
}
