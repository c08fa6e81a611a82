//! Simulated sensors.

mod gaussian_odometry;
mod instrument;
pub mod laser;
pub mod range_bearing;
mod wheel_odometry;

pub use gaussian_odometry::{GaussianOdometry, GaussianOdometryParams};
pub use instrument::{SensorReading, SimulatedSensor, TrueState};
pub use laser::{Laser, LaserParams};
pub use range_bearing::{RangeBearingDetector, RangeBearingParams};
pub use wheel_odometry::{OdometryEncoding, WheelOdometry, WheelOdometryParams};
