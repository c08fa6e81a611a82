//! The robot: four legs, a head that looks around, and odometry that guesses.

mod head;
mod legged;
mod odometry;
mod params;
mod walker;

pub use legged::Legged;
pub use params::{GaitOdometryParams, HeadParams, RobotParams, SwayParams, WalkParams};
