//! Conversion of light to images.

mod camera;
mod camera_simulator;
mod exposure;
mod image_pipeline;
mod layer;
mod scene;
mod surface;
mod view;

pub use camera::{CameraParams, Chroma};
pub use camera_simulator::{CameraSimulator, Picture};
pub use scene::Scene;
pub use surface::{Form, Material, Surface};
