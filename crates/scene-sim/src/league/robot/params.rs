use crate::random::NoiseShape;
use crate::{SimulationError, check};

/// A four-legged robot: gait, sway, head motion, and its odometry.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct LeggedRobotParams {
    /// Gait.
    pub walk: FieldWalkParams,
    /// Motion of the body.
    pub sway: BodySwayParams,
    /// Motion of the head.
    pub head: RobotHeadParams,
    /// Odometry from steps.
    pub odometry: GaitOdometryParams,
}

/// Path: between random points of the field, forwards or sideways, with turns and rests.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct FieldWalkParams {
    /// Speed, m/s; 0 never leaves its place. Default 0.25.
    pub speed_mps: f64,
    /// Turning rate, rad/s. Default 1.
    pub turn_radps: f64,
    /// Time constant of the speed, s. Default 0.15.
    pub speed_time_constant_s: f64,
    /// Mean length of a rest, seconds. Default 0.5.
    pub mean_rest_s: f64,
    /// Share of legs of the path walked without turning first. Default 0.25.
    pub sideways_share: f64,
    /// Distance from the boards, m, at most 1. Default 0.35.
    pub min_board_distance_m: f64,
}

/// Motion of the body with the gait, which the joints of the head do not measure.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct BodySwayParams {
    /// Length of one stride, seconds. Default 0.5.
    pub stride_period_s: f64,
    /// Amplitude of the roll at full speed, radians. Default 1°.
    pub roll_amplitude_rad: f64,
    /// Amplitude of the pitch at full speed, radians. Default 0.7°.
    pub pitch_amplitude_rad: f64,
    /// Amplitude of the height at full speed, metres. Default 0.004.
    pub height_amplitude_m: f64,
    /// σ of a slow error of roll and pitch, walking or not, radians: the carpet is soft. Default 0.3°.
    pub tilt_error_sigma_rad: f64,
}

/// The head: pan and tilt, and a camera in its nose.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct RobotHeadParams {
    /// Top speed of a joint, rad/s. Default 2.
    pub speed_radps: f64,
    /// Furthest pan to either side, radians. Default 88°.
    pub pan_limit_rad: f64,
    /// Mean time of a gaze, s. Default 0.5.
    pub mean_gaze_duration_s: f64,
    /// Share of gazes at the carpet ahead instead of a landmark. Default 0.15.
    pub downward_gaze_share: f64,
    /// Resolution of the reported angles, radians; 0 for none. Default 0.25°.
    pub angle_resolution_rad: f64,
    /// Delay of reported angles, s. Default 0.008.
    pub angle_latency_s: f64,
    /// σ of the constant error of pan, tilt and roll of the camera, radians. Default 0.35°.
    pub angle_bias_sigma_rad: f64,
}

/// Odometry from the commanded steps.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct GaitOdometryParams {
    /// Bounds of the share of a commanded step forwards or sideways that becomes motion; drawn once per axis. Default 0.8 to 1.1.
    pub step_scale_range: [f64; 2],
    /// The same for turning. Default 0.9 to 1.1.
    pub turn_scale_range: [f64; 2],
    /// σ of the relative error of an increment. Default 0.1.
    pub noise: f64,
    /// Shape of that error. Default Student's t with 4 degrees of freedom.
    pub noise_shape: NoiseShape,
    /// σ of the unmeasured rotation per distance, rad/m. Default 0.08.
    pub drift_sigma_rad_per_m: f64,
    /// Correlation time of that drift, seconds. Default 8.
    pub drift_correlation_s: f64,
}

impl Default for LeggedRobotParams {
    fn default() -> Self {
        let degrees = f64::to_radians;
        Self {
            walk: FieldWalkParams {
                speed_mps: 0.25,
                turn_radps: 1.0,
                speed_time_constant_s: 0.15,
                mean_rest_s: 0.5,
                sideways_share: 0.25,
                min_board_distance_m: 0.35,
            },
            sway: BodySwayParams {
                stride_period_s: 0.5,
                roll_amplitude_rad: degrees(1.0),
                pitch_amplitude_rad: degrees(0.7),
                height_amplitude_m: 0.004,
                tilt_error_sigma_rad: degrees(0.3),
            },
            head: RobotHeadParams {
                speed_radps: 2.0,
                pan_limit_rad: degrees(88.0),
                mean_gaze_duration_s: 0.5,
                downward_gaze_share: 0.15,
                angle_resolution_rad: degrees(0.25),
                angle_latency_s: 0.008,
                angle_bias_sigma_rad: degrees(0.35),
            },
            odometry: GaitOdometryParams {
                step_scale_range: [0.8, 1.1],
                turn_scale_range: [0.9, 1.1],
                noise: 0.1,
                noise_shape: NoiseShape::StudentT { degrees_of_freedom: 4.0 },
                drift_sigma_rad_per_m: 0.08,
                drift_correlation_s: 8.0,
            },
        }
    }
}

impl LeggedRobotParams {
    /// Whether the numbers make a robot.
    ///
    /// # Errors
    /// Returns an error with the first parameter that is out of range.
    pub fn validate(&self) -> Result<(), SimulationError> {
        let Self { walk, sway, head, odometry } = self;
        check::not_negative("speed (m/s)", walk.speed_mps)?;
        check::positive("turning rate (rad/s)", walk.turn_radps)?;
        check::positive("speed time constant (s)", walk.speed_time_constant_s)?;
        check::not_negative("rest (s)", walk.mean_rest_s)?;
        check::share("share of walks sideways", walk.sideways_share)?;
        check::not_negative("margin (m)", walk.min_board_distance_m)?;
        check::at_most("margin (m)", walk.min_board_distance_m, 1.0, "at most 1")?;
        check::positive("stride (s)", sway.stride_period_s)?;
        check::not_negative("roll (rad)", sway.roll_amplitude_rad)?;
        check::not_negative("pitch (rad)", sway.pitch_amplitude_rad)?;
        check::not_negative("swaying height (m)", sway.height_amplitude_m)?;
        check::not_negative("slow roll and pitch (rad)", sway.tilt_error_sigma_rad)?;
        check::positive("speed of the head (rad/s)", head.speed_radps)?;
        check::not_negative("furthest pan (rad)", head.pan_limit_rad)?;
        check::not_negative("mean duration of a gaze (s)", head.mean_gaze_duration_s)?;
        check::share("share of downward gazes", head.downward_gaze_share)?;
        check::not_negative("resolution of the joints (rad)", head.angle_resolution_rad)?;
        check::not_negative("latency of the angles (s)", head.angle_latency_s)?;
        check::not_negative("error of the joints (rad)", head.angle_bias_sigma_rad)?;
        for scale in [odometry.step_scale_range, odometry.turn_scale_range].concat() {
            check::positive("scale of the odometry", scale)?;
        }
        check::not_negative("error of the odometry", odometry.noise)?;
        odometry.noise_shape.validate()?;
        check::not_negative("drift of the odometry (rad/m)", odometry.drift_sigma_rad_per_m)?;
        check::not_negative("correlation time of the drift (s)", odometry.drift_correlation_s)
    }
}
