//! Linear models and the Kalman filter proper.

mod component;
mod filter;
mod motion;
mod sensor;

pub use component::update_component;
pub use filter::{KalmanFilter, LinearInnovation, LinearUpdate};
pub use motion::LinearMotion;
pub use sensor::LinearSensor;
