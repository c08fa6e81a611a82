use crate::{SimulationError, check};

/// A robot on two wheels: nominal parameters and true deviations.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct WheeledRobotParams {
    /// Cruising speed, m/s; 0 stands still. Default 0.5.
    pub speed_mps: f64,
    /// Largest change of speed, m/s². Default 0.5.
    pub acceleration_mps2: f64,
    /// Wheel radius on the data sheet, metres. Default 0.05.
    pub wheel_radius_m: f64,
    /// Distance between the wheels on the data sheet, metres. Default 0.30.
    pub wheel_separation_m: f64,
    /// Relative error of the true radius of the left wheel. Default 0.
    pub left_radius_error: f64,
    /// Relative error of the true radius of the right wheel. Default 0.
    pub right_radius_error: f64,
    /// Relative error of the true track. Default 0.
    pub wheel_separation_error: f64,
    /// Time constant of the wheel speeds, s; 0 for an immediate response. Default 0.1.
    pub motor_lag_s: f64,
    /// Lookahead of the driver on the route, m. Default 0.5.
    pub lookahead_m: f64,
    /// Slip of the wheels. Default none.
    pub slip: WheelSlipParams,
}

/// Share of a wheel's rotation lost to slip: a Gauss-Markov process per wheel.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct WheelSlipParams {
    /// Standard deviation of the share. Default 0.
    pub slip_sigma: f64,
    /// Correlation time, seconds. Default 1.
    pub correlation_time_s: f64,
    /// Correlation between the two wheels, in [0, 1]: both stand on the same floor. Default 0.
    pub wheel_correlation: f64,
}

impl Default for WheeledRobotParams {
    fn default() -> Self {
        Self {
            speed_mps: 0.5,
            acceleration_mps2: 0.5,
            wheel_radius_m: 0.05,
            wheel_separation_m: 0.30,
            left_radius_error: 0.0,
            right_radius_error: 0.0,
            wheel_separation_error: 0.0,
            motor_lag_s: 0.1,
            lookahead_m: 0.5,
            slip: WheelSlipParams::default(),
        }
    }
}

impl Default for WheelSlipParams {
    fn default() -> Self {
        Self { slip_sigma: 0.0, correlation_time_s: 1.0, wheel_correlation: 0.0 }
    }
}

impl WheeledRobotParams {
    /// Whether the numbers make a robot.
    ///
    /// # Errors
    /// Returns an error with the first parameter that is out of range.
    pub fn validate(&self) -> Result<(), SimulationError> {
        check::not_negative("speed (m/s)", self.speed_mps)?;
        check::positive("acceleration (m/s²)", self.acceleration_mps2)?;
        check::positive("wheel radius (m)", self.wheel_radius_m)?;
        check::positive("track (m)", self.wheel_separation_m)?;
        check::relative_error("error of the left radius", self.left_radius_error)?;
        check::relative_error("error of the right radius", self.right_radius_error)?;
        check::relative_error("error of the track", self.wheel_separation_error)?;
        check::not_negative("motor lag (s)", self.motor_lag_s)?;
        check::positive("lookahead (m)", self.lookahead_m)?;
        check::not_negative("sigma of the slip", self.slip.slip_sigma)?;
        check::not_negative("correlation time of the slip (s)", self.slip.correlation_time_s)?;
        check::share("shared part of the slip", self.slip.wheel_correlation)
    }
}
