//! Named, seeded set-ups: what fixtures are made of.

mod catalogue;
mod laser;
mod league;
mod named;
mod planar;
mod store;

pub use laser::LaserDriveParams;
pub use named::{Scenario, ScenarioParams};
pub use planar::{OdometryParams, OtherRobotParams, PlanarParams};
pub use store::StoreLapsParams;
