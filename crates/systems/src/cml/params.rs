use schemars::JsonSchema;
use serde::{Deserialize, Serialize};
use wayfix_appearance_cml::{LocalizerParams, OdometryNoise, PanoramaParams};

use crate::system::VELOCITY_HOLD;

/// Everything that `wayfix run cml` is tuned by. What a file of parameters does not name keeps its default.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(default, deny_unknown_fields)]
pub struct CmlParams {
    /// A velocity holds for this long after its stamp, s; then the motion is unknown. The default is the command time-out of ROS 2
    /// navigation.
    pub velocity_hold: f64,
    /// By how much odometry is stamped later than images that show the same, s; negative where it is stamped earlier.
    pub odometry_delay: f64,
    /// What is known of the poses that a map is taught with.
    pub taught_pose: PoseSigmas,
    /// What is known of the start.
    pub start: PoseSigmas,
    /// How a folder of frames, which has no odometry, comes by one.
    pub synthetic_odometry: SyntheticOdometry,
    /// How panoramas are described.
    pub views: PanoramaParams,
    /// The localizer.
    pub localizer: LocalizerParams,
}

impl Default for CmlParams {
    fn default() -> Self {
        Self {
            velocity_hold: VELOCITY_HOLD,
            odometry_delay: 0.0,
            taught_pose: PoseSigmas::default(),
            start: PoseSigmas::default(),
            synthetic_odometry: SyntheticOdometry::default(),
            views: PanoramaParams::default(),
            localizer: LocalizerParams::default(),
        }
    }
}

/// Standard deviations of a pose.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(default, deny_unknown_fields)]
pub struct PoseSigmas {
    /// Of x and y, metres.
    pub position: f64,
    /// Of the heading, radians.
    pub heading: f64,
}

impl Default for PoseSigmas {
    fn default() -> Self {
        Self { position: 0.02, heading: 0.05 }
    }
}

/// Odometry made of a path: its increments, smoothed, with noise.
#[derive(Clone, Copy, Debug, Default, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(default, deny_unknown_fields)]
pub struct SyntheticOdometry {
    /// Standard deviation of the Gaussian that smooths the path, in frames: what measures a path trembles, wheels do not. As much as the path
    /// trembles, when not given.
    pub smoothing_frames: Option<f64>,
    /// The noise; as much as the localizer reckons with, unless said otherwise.
    pub noise: OdometryNoise,
}
