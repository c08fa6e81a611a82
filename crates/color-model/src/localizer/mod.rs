//! Localization in a coloured map with adaptive colours: the Rao-Blackwellised particle filter of [Schulz & Fox 2004, IV].

mod background;
mod buffer;
mod camera;
mod color_localizer;
mod estimate;
mod filter;
mod frame;
mod odometry;
mod outcome;
mod params;
mod places;
mod robot_camera;
mod search;

pub use camera::{CameraLocation, CameraPoseError, CameraPoseNoise};
pub use color_localizer::{ColorLocalizer, ColorLocalizerModels};
pub use estimate::PoseEstimate;
pub use odometry::{OdometryModel, OdometryNoise, OdometryStep};
pub use outcome::{FrameOutcome, LocalizationStatus};
pub use params::{GlobalSearchParams, LocalizerParams};
pub use search::StartPosePrior;
