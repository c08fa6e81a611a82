use schemars::JsonSchema;
use serde::{Deserialize, Serialize};
use wayfix_appearance_cml::{LocalizerParams, OdometryNoise, PanoramaDescriptorParams};
use wayfix_slam_ekf::ExternalParams;
use wayfix_system_core::VELOCITY_TIMEOUT;

/// Parameters of `wayfix run cml`. Keys that a parameter file omits keep their defaults.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(default, deny_unknown_fields)]
pub struct CmlParams {
    /// A velocity holds for this long after its stamp, s; then the motion is unknown. Default: as in ROS 2 navigation.
    pub velocity_timeout: f64,
    /// Delay of the odometry stamps relative to images of the same motion, s; negative if odometry is stamped early.
    pub odometry_delay: f64,
    /// Uncertainty of the poses of the training views.
    pub taught_pose_uncertainty: PoseSigmas,
    /// Uncertainty of the start pose.
    pub start_uncertainty: PoseSigmas,
    /// Synthetic odometry for a folder of frames, which has none.
    pub synthetic_odometry: SyntheticOdometry,
    /// Sensors of the pose that do not use the map: positions of the robot, headings, poses. Measurements outside the chi-squared gate of 0.9999 are rejected.
    pub external: ExternalParams,
    /// Parameters of the panorama descriptors.
    pub panorama_descriptor: PanoramaDescriptorParams,
    /// The localizer.
    pub localizer: LocalizerParams,
}

impl Default for CmlParams {
    fn default() -> Self {
        Self {
            velocity_timeout: VELOCITY_TIMEOUT,
            odometry_delay: 0.0,
            taught_pose_uncertainty: PoseSigmas::default(),
            start_uncertainty: PoseSigmas::default(),
            synthetic_odometry: SyntheticOdometry::default(),
            external: ExternalParams::default(),
            panorama_descriptor: PanoramaDescriptorParams::default(),
            localizer: LocalizerParams::default(),
        }
    }
}

/// Standard deviations of a pose.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(default, deny_unknown_fields)]
pub struct PoseSigmas {
    /// Of x and y, m.
    pub position_sigma: f64,
    /// Of the heading, rad.
    pub heading_sigma: f64,
}

impl Default for PoseSigmas {
    fn default() -> Self {
        Self { position_sigma: 0.02, heading_sigma: 0.05 }
    }
}

/// Odometry computed from a path: its smoothed increments with noise.
#[derive(Clone, Copy, Debug, Default, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(default, deny_unknown_fields)]
pub struct SyntheticOdometry {
    /// Standard deviation of the Gaussian that smooths the path, in frames; it removes measurement noise that wheels do not have.
    /// Estimated from the path if not given.
    pub smoothing_frames: Option<f64>,
    /// Noise of the increments; the default is the noise that the localizer assumes.
    pub noise: OdometryNoise,
}
