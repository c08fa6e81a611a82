//! Cameras without sins, and scenes that make one thing measurable.

use rand_chacha::{ChaCha8Rng, rand_core::SeedableRng};
use wayfix_estimation_traits::{Pose3, nalgebra::Vector3};
use wayfix_scene_sim::league::{
    Backdrop, CameraParams, CameraSimulator, ChromaSubsampling, LampLight, LeaguePicture, LeagueScene,
    LightField, LinearRgb, N_COLORS, SceneSurface, SurfaceHit,
};
use wayfix_scene_sim::random::RandomStreams;
use wayfix_scene_sim::space;

pub(crate) fn streams(seed: u64) -> RandomStreams {
    RandomStreams::new(ChaCha8Rng::seed_from_u64(seed))
}

/// Linear, noiseless, without falling corners.
pub(crate) fn honest() -> CameraParams {
    CameraParams {
        vignetting: LinearRgb::zeros(),
        crosstalk: 0.0,
        stray_light: 0.0,
        full_well_electrons: 1e15,
        read_noise_sigma: 0.0,
        gamma: 1.0,
        chroma_subsampling: ChromaSubsampling::Each,
        white_balance_drift_sigma: 0.0,
        ..CameraParams::ers7().expect("a sound camera")
    }
}

/// A wall of one reflectance wherever one looks.
pub(crate) struct Blank(pub(crate) LinearRgb);

impl Backdrop for Blank {
    fn surface_hit(&self, eye: &Vector3<f64>, direction: &Vector3<f64>) -> SurfaceHit {
        SurfaceHit { point: eye + direction, normal: Vector3::z(), reflectance: self.0 }
    }
}

pub(crate) fn even_light() -> LampLight {
    LampLight { lamps: vec![], ambient: LinearRgb::repeat(1.0), bounce: LinearRgb::repeat(1.0) }
}

/// A picture of a blank wall of this reflectance.
pub(crate) fn of_blank(camera: CameraParams, reflectance: LinearRgb) -> LeaguePicture {
    let paints = [LinearRgb::zeros(); N_COLORS];
    let (light, backdrop) = (even_light(), Blank(reflectance));
    let scene = LeagueScene { surfaces: vec![], paints: &paints, light: &light, backdrop: &backdrop };
    let pose = looking([0.0, 0.0, 0.3], 0.0, 0.0);
    take(camera, &scene, [&pose, &pose])
}

pub(crate) fn take(camera: CameraParams, scene: &LeagueScene<'_>, poses: [&Pose3<f64>; 2]) -> LeaguePicture {
    let mut camera_simulator = CameraSimulator::new(camera).expect("a sound camera");
    camera_simulator.take(scene, poses, &LinearRgb::repeat(1.0), &mut ChaCha8Rng::seed_from_u64(5))
}

/// The field in even light, every colour painted its own grey.
pub(crate) fn field_in<'a>(
    light: &'a dyn LightField,
    backdrop: &'a dyn Backdrop,
    paints: &'a [LinearRgb],
) -> LeagueScene<'a> {
    let map = wayfix_scene_sim::league::field_map().expect("a sound map");
    LeagueScene { surfaces: SceneSurface::of_map(&map), paints, light, backdrop }
}

pub(crate) fn looking(from: [f64; 3], yaw: f64, pitch: f64) -> Pose3<f64> {
    Pose3 { translation: Vector3::from(from), rotation: space::yaw(yaw) * space::pitch(pitch) }
}

/// One channel of a pixel.
pub(crate) fn channel(picture: &LeaguePicture, column: u32, row: u32, channel: usize) -> f64 {
    f64::from(picture.rgb[3 * (row * picture.width + column) as usize + channel])
}

pub(crate) fn mean(values: &[f64]) -> f64 {
    values.iter().sum::<f64>() / values.len() as f64
}

pub(crate) fn deviation(values: &[f64]) -> f64 {
    let centre = mean(values);
    mean(&values.iter().map(|v| (v - centre) * (v - centre)).collect::<Vec<_>>()).sqrt()
}
