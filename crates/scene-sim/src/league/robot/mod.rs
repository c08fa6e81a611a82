//! The robot: four legs, a moving head, and odometry from commands.

mod head;
mod legged;
mod odometry;
mod params;
mod walker;

pub use legged::LeggedRobot;
pub use params::{BodySwayParams, FieldWalkParams, GaitOdometryParams, LeggedRobotParams, RobotHeadParams};
