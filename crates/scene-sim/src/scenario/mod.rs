//! Named, seeded set-ups: what fixtures are made of.

mod catalogue;
mod laser;
mod league;
mod named;
mod planar;

pub use laser::LaserDriveParams;
pub use named::{Scenario, ScenarioParams};
pub use planar::{OdometryParams, OtherRobotParams, PlanarParams};
