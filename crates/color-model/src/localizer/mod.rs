//! Where the robot is and what the light is, at once: the Rao-Blackwellised particle filter of [Schulz & Fox 2004, IV].

mod camera_error;
mod estimate;
mod filter;
mod fitness;
mod light;
mod odometry;
mod outcome;
mod palette;
mod params;
mod particle;
mod relight;
mod renewal;
mod start;
mod surroundings;
mod weigh;
mod weighed;

pub use camera_error::{CameraError, CameraNoise};
pub use estimate::PoseEstimate;
pub use filter::ColorLocalizer;
pub use odometry::{OdometryNoise, OdometryStep};
pub use outcome::{Fix, FrameOutcome};
pub use params::LocalizerParams;
pub use particle::CameraLocation;
pub use start::Start;
