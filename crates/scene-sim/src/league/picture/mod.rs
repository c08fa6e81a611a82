//! How light becomes a picture.

mod camera;
mod develop;
mod exposure;
mod layer;
mod photographer;
mod scene;
mod surface;
mod view;

pub use camera::{CameraParams, Chroma};
pub use photographer::{Photographer, Picture};
pub use scene::Scene;
pub use surface::{Form, Skin, Surface};
