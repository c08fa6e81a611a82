//! Stores and rooms, and the views of an omnidirectional camera: textured walls, shelves, windows, people, changing light.
//!
//! A [`RetailStore`] or a [`Laboratory`] is drawn from a seed, and rearranged by a share some weeks later; its [`Building`] has the drivable
//! [`AisleGrid`]; an [`IndoorDrive`] gives views, drifting odometry and true poses one step after another.
//!
//! A view is drawn panel by panel into a buffer of depths, one ray for each quarter of a pixel; each ray has its colour from a
//! texture with the resolution of the ray's width, which avoids flicker under motion, and 120 × 20 pixels cost less than half a millisecond.

mod ambient_light;
mod camera;
mod canvas;
mod color;
mod depths;
mod drive;
mod image_pipeline;
mod light;
mod panel;
mod params;
mod rooms;
mod rounded;
mod texture;
mod view;

pub use ambient_light::AmbientLightParams;
pub use camera::OmniCameraParams;
pub use drive::{IndoorDrive, IndoorDriveStep};
pub use params::{IndoorDriveParams, calibrated_robot};
pub use rooms::aisles::{AisleCrossing, AisleGrid};
pub use rooms::building::Building;
pub use rooms::lab::Laboratory;
pub use rooms::store::RetailStore;
pub use rooms::store_params::RetailStoreParams;
