//! Pictures painted from the map of the four-legged field, in one light.

use std::sync::Arc;

use nalgebra::{DMatrix, DVector, UnitQuaternion, Vector3};
use rand::Rng;
use wayfix_color_map::{ColorId, ColorMap, MapRenderer, PinholeCamera};
use wayfix_color_model::{LightingFilter, LightingFilterBank, LightingFilterParams, YuvImage};
use wayfix_estimation_traits::{LieGroup, Pose2, Pose3};
use wayfix_gaussian_core::Gaussian;
use wayfix_kalman::MarkovChain;
use wayfix_scene_sim::league::field_map;

use super::normal;

/// Y, U, V of green, white, yellow, cyan, pink.
const LIGHT: [[f64; 3]; 5] =
    [[70., 123., 113.], [130., 124., 120.], [116., 88., 140.], [90., 146., 104.], [103., 130., 162.]];

/// A wall, which no colour of the map resembles.
const WALL: [f64; 3] = [30.0, 180.0, 180.0];

/// Standard deviation of a pixel's noise, as a JPEG of a cheap camera has it.
const PIXEL_SIGMA: f64 = 4.0;

/// The field, and a robot's camera above it.
pub(crate) struct Scene {
    pub(crate) map: Arc<ColorMap>,
    pub(crate) camera: PinholeCamera,
    renderer: MapRenderer,
}

impl Scene {
    /// Half as fine as the camera of an ERS-7, so that tests take a quarter of the time.
    pub(crate) fn new() -> Self {
        let map = Arc::new(field_map().expect("a constant map"));
        let camera = PinholeCamera::from_field_of_view(104, 80, 0.993, 0.789).expect("an ERS-7");
        let renderer = MapRenderer::new(Arc::clone(&map), camera);
        Self { map, camera, renderer }
    }

    /// Labels from a camera pose, row by row; `None` beside the map.
    pub(crate) fn labels(&mut self, camera_pose: &Pose3<f64>) -> Vec<Option<ColorId>> {
        self.renderer.labels(camera_pose).expect("a finite pose").pixels().to_vec()
    }

    /// What a camera sees, with noise, in front of a wall.
    pub(crate) fn paint(&mut self, camera_pose: &Pose3<f64>, rng: &mut impl Rng) -> YuvImage {
        let labels = self.labels(camera_pose);
        let pixel = |label: &Option<ColorId>| {
            label
                .map_or(WALL, |color| LIGHT[color.index()])
                .map(|value| (value + PIXEL_SIGMA * normal(rng)).round().clamp(0.0, 255.0) as u8)
        };
        self.image(labels.iter().map(pixel).collect())
    }

    /// Pixels with noise that show the wall only.
    pub(crate) fn wall(&self, rng: &mut impl Rng) -> YuvImage {
        let n_pixels = self.camera.width() * self.camera.height();
        let mut pixel =
            || WALL.map(|value| (value + PIXEL_SIGMA * normal(rng)).round().clamp(0.0, 255.0) as u8);
        self.image((0..n_pixels).map(|_| pixel()).collect())
    }

    pub(crate) fn image(&self, pixels: Vec<[u8; 3]>) -> YuvImage {
        YuvImage::new(self.camera.width(), self.camera.height(), pixels)
            .expect("as many pixels as the camera")
    }
}

/// Where the camera is in the robot's frame: 20 cm above the ground, turned by `pan` to the left, a little down.
pub(crate) fn mount(pan: f64) -> Pose3<f64> {
    Pose3 {
        translation: Vector3::new(0.08, 0.0, 0.19),
        rotation: UnitQuaternion::from_euler_angles(0.0, 0.1, pan),
    }
}

pub(crate) fn camera_pose(body: &Pose2<f64>, mount: &Pose3<f64>) -> Pose3<f64> {
    Pose3 {
        translation: body.translation.push(0.0),
        rotation: UnitQuaternion::from_euler_angles(0.0, 0.0, body.heading()),
    }
    .compose(mount)
}

/// The light, known to a standard deviation of 12 of 255 in each channel, of which 9 are common to all colours.
pub(crate) fn light() -> LightingFilter {
    let mean = DVector::from_iterator(15, LIGHT.into_iter().flatten());
    let covariance = DMatrix::from_fn(15, 15, |i, j| match (i == j, i % 3 == j % 3) {
        (true, _) => 144.0,
        (false, true) => 81.0,
        (false, false) => 0.0,
    });
    let prior = Gaussian::new(mean, covariance).expect("positive definite");
    LightingFilter::new(prior, LightingFilterParams::default()).expect("default parameters")
}

pub(crate) fn bank() -> LightingFilterBank {
    let chain = MarkovChain::sticky(1, 1.0).expect("a probability");
    LightingFilterBank::new(vec![light()], chain).expect("one of each")
}
