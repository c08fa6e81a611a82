//! Conversion of light to images.

mod camera;
mod camera_simulator;
mod exposure;
mod image_pipeline;
mod layer;
mod scene;
mod surface;
mod view;

pub use camera::{CameraParams, ChromaSubsampling, ExposureMode};
pub use camera_simulator::{CameraSimulator, LeaguePicture};
pub use scene::LeagueScene;
pub use surface::{Material, SceneSurface, SurfaceShape};
