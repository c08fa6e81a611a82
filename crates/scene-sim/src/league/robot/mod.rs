//! The robot: four legs, a moving head, and odometry from commands.

mod head;
mod legged;
mod odometry;
mod params;
mod walker;

pub use legged::Legged;
pub use params::{GaitOdometryParams, HeadParams, RobotParams, SwayParams, WalkParams};
