use rand::Rng;

use super::{AmbientLightParams, OmniCameraParams};
use crate::drive::{WheelSlipParams, WheeledRobotParams};
use crate::random::deviate::normal;
use crate::sensor::{OdometryEncoding, WheelOdometryParams};
use crate::{SimulationError, check};

/// A robot in a building, and the people around it.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct IndoorDriveParams {
    /// The robot; [`calibrated_robot`] draws one. Default: 0.5 m/s, wheels exactly as built, slip of 0.1 %.
    pub robot: WheeledRobotParams,
    /// Time between two views, a multiple of 10 ms. Default 500: a step of 0.25 m.
    pub view_period_ms: u32,
    /// The camera.
    pub camera: OmniCameraParams,
    /// The light.
    pub ambient_light: AmbientLightParams,
    /// Number of walking people. Default 0.
    pub n_people: usize,
}

impl Default for IndoorDriveParams {
    fn default() -> Self {
        Self {
            robot: robot([0.0; 2]),
            view_period_ms: 500,
            camera: OmniCameraParams::default(),
            ambient_light: AmbientLightParams::default(),
            n_people: 0,
        }
    }
}

impl IndoorDriveParams {
    /// Whether the numbers have a meaning.
    ///
    /// # Errors
    /// Returns an error with the first parameter that is out of range.
    pub fn validate(&self) -> Result<(), SimulationError> {
        self.robot.validate()?;
        check::above("time between views (ms)", f64::from(self.view_period_ms), 9.0, "at least 10")?;
        check::at_most("time between views (ms) modulo 10", f64::from(self.view_period_ms % 10), 0.0, "0")?;
        self.camera.validate()?;
        self.ambient_light.validate()?;
        check::count("people", self.n_people, 1000)
    }

    /// Encoders with nominal parameters.
    pub(super) fn odometry(&self) -> WheelOdometryParams {
        WheelOdometryParams {
            encoding: OdometryEncoding::Increment,
            period_ms: self.view_period_ms,
            wheel_radius_m: self.robot.wheel_radius_m,
            wheel_separation_m: self.robot.wheel_separation_m,
            ..WheelOdometryParams::default()
        }
    }
}

/// A robot with manually calibrated wheels: errors of 0.3 % in distance and 10⁻⁴ rad/m in heading (σ), in addition to slip,
/// which turns it by 0.1° on the first metre and by 1° over 100 m.
pub fn calibrated_robot<R: Rng + ?Sized>(rng: &mut R) -> WheeledRobotParams {
    robot([3e-3 * normal(rng), 1e-4 * normal(rng)])
}

/// A robot with an error of its travel (share) and of its heading (rad/m).
fn robot([travel, heading_per_m]: [f64; 2]) -> WheeledRobotParams {
    const TRACK_M: f64 = 0.5;
    let difference = 0.5 * heading_per_m * TRACK_M;
    WheeledRobotParams {
        speed_mps: 0.5,
        wheel_separation_m: TRACK_M,
        wheel_radius_m: 0.1,
        left_radius_error: travel - difference,
        right_radius_error: travel + difference,
        slip: WheelSlipParams { slip_sigma: 1e-3, correlation_time_s: 1.0, wheel_correlation: 0.5 },
        ..WheeledRobotParams::default()
    }
}
