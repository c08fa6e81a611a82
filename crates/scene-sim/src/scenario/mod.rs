//! Named, seeded set-ups, the sources of fixtures.

mod catalogue;
mod laser;
#[cfg(feature = "league")]
mod league;
mod named;
mod planar;
#[cfg(feature = "indoors")]
mod store;

pub use laser::LaserDriveParams;
pub use named::{Scenario, ScenarioParams};
pub use planar::{OdometryParams, OtherRobotParams, PlanarDriveParams};
#[cfg(feature = "indoors")]
pub use store::RetailStoreLapsParams;
