//! True motion of the robot: two wheels, slip, and a driver that follows a route.

mod differential;
mod params;
mod pursuit;

pub use differential::DifferentialDrive;
pub use params::{WheelSlipParams, WheeledRobotParams};
pub use pursuit::PurePursuit;
