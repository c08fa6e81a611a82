use wayfix_estimation_traits::Pose2;
use wayfix_sensor_log::RecordData;

use super::{SensorReading, SimulatedSensor, TrueState};
use crate::random::{RandomStreamPurpose, RandomStreams, deviate};
use crate::{SimulationError, check, plane};

/// Increments of the true pose plus white Gaussian noise: the odometry that textbook filters assume.
///
/// With its defaults the noise of the shared range-bearing logs; for tests of a filter's consistency.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct GaussianOdometryParams {
    /// Time from one increment to the next, milliseconds. Default 500.
    pub period_ms: u32,
    /// σ of x and y of each increment, metres. Default 0.02.
    pub increment_position_sigma_m: f64,
    /// σ of the turn of each increment, radians. Default 0.005.
    pub increment_heading_sigma_rad: f64,
}

impl Default for GaussianOdometryParams {
    fn default() -> Self {
        Self { period_ms: 500, increment_position_sigma_m: 0.02, increment_heading_sigma_rad: 0.005 }
    }
}

impl GaussianOdometryParams {
    /// Whether the numbers have a meaning.
    ///
    /// # Errors
    /// Returns an error with the first parameter that is out of range.
    pub fn validate(&self) -> Result<(), SimulationError> {
        check::period("period of the odometry (ms)", self.period_ms)?;
        check::not_negative("σ of odometry increments (m)", self.increment_position_sigma_m)?;
        check::not_negative("σ of odometry turns (rad)", self.increment_heading_sigma_rad)
    }
}

/// The instrument to [`GaussianOdometryParams`].
#[derive(Clone, Debug, PartialEq)]
pub struct GaussianOdometry {
    params: GaussianOdometryParams,
    last: Option<Pose2<f64>>,
}

impl GaussianOdometry {
    /// Odometry that has not begun yet.
    ///
    /// # Errors
    /// Returns [`SimulationError::Parameter`] if a parameter is out of range.
    pub fn new(params: GaussianOdometryParams) -> Result<Self, SimulationError> {
        params.validate()?;
        Ok(Self { params, last: None })
    }
}

impl SimulatedSensor for GaussianOdometry {
    fn period_ms(&self) -> u32 {
        self.params.period_ms
    }

    fn sense(&mut self, moment: &TrueState<'_>, streams: &mut RandomStreams) -> Option<SensorReading> {
        let last = self.last.replace(moment.pose)?;
        let step = plane::relative(&last, &moment.pose);
        let mut noise = |sigma: f64| sigma * deviate::normal(streams.of(RandomStreamPurpose::OdometryNoise));
        let noisy = Pose2::new(
            step.x() + noise(self.params.increment_position_sigma_m),
            step.y() + noise(self.params.increment_position_sigma_m),
            step.heading() + noise(self.params.increment_heading_sigma_rad),
        );
        Some(SensorReading { data: RecordData::OdometryIncrement(noisy), stamp_offset_ms: 0 })
    }
}
