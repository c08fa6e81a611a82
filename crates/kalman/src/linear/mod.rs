//! Linear models and the Kalman filter proper.

mod filter;
mod motion;
mod sensor;

pub use filter::{KalmanFilter, LinearInnovation, LinearUpdate};
pub use motion::LinearMotion;
pub use sensor::LinearSensor;
