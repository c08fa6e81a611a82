use std::f64::consts::TAU;

use wayfix_estimation_traits::Pose2;
use wayfix_sensor_log::{RecordData, Velocity};

use super::{SensorReading, SimulatedSensor, TrueState};
use crate::random::{RandomStreamPurpose, RandomStreams, deviate};
use crate::{SimulationError, check, plane};

/// Form of wheel odometry in the log.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum OdometryEncoding {
    /// Mean velocity over a period, stamped at its beginning: holding it until the next retraces the motion.
    Velocity,
    /// Motion over a period, stamped at its end.
    Increment,
}

/// Encoders on two wheels, evaluated with the data sheet.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct WheelOdometryParams {
    /// Velocities or increments. Default increments.
    pub encoding: OdometryEncoding,
    /// Length of a period, milliseconds. Default 100.
    pub period_ms: u32,
    /// Wheel radius that the odometry assumes, metres. Default 0.05.
    pub wheel_radius_m: f64,
    /// Track that the odometry assumes, metres. Default 0.30.
    pub wheel_separation_m: f64,
    /// Encoder ticks per turn of a wheel; `None` measures angles exactly. Default 2000.
    pub ticks_per_turn: Option<u32>,
    /// σ of the white error of each wheel's travel, as a share of the travel. Default 0.
    pub travel_sigma_share: f64,
}

impl Default for WheelOdometryParams {
    fn default() -> Self {
        Self {
            encoding: OdometryEncoding::Increment,
            period_ms: 100,
            wheel_radius_m: 0.05,
            wheel_separation_m: 0.30,
            ticks_per_turn: Some(2000),
            travel_sigma_share: 0.0,
        }
    }
}

impl WheelOdometryParams {
    /// Whether the numbers have a meaning.
    ///
    /// # Errors
    /// Returns an error with the first parameter that is out of range.
    pub fn validate(&self) -> Result<(), SimulationError> {
        check::period("period of the odometry (ms)", self.period_ms)?;
        check::positive("wheel radius of the odometry (m)", self.wheel_radius_m)?;
        check::positive("track of the odometry (m)", self.wheel_separation_m)?;
        check::positive("encoder ticks per turn", self.ticks_per_turn.map_or(1.0, f64::from))?;
        check::not_negative("σ of a wheel's travel", self.travel_sigma_share)
    }
}

/// The instrument to [`WheelOdometryParams`].
#[derive(Clone, Debug, PartialEq)]
pub struct WheelOdometry {
    params: WheelOdometryParams,
    last: Option<[f64; 2]>,
}

impl WheelOdometry {
    /// Encoders at their initial count.
    /// # Errors
    /// Returns [`SimulationError::Parameter`] if a parameter is out of range.
    pub fn new(params: WheelOdometryParams) -> Result<Self, SimulationError> {
        params.validate()?;
        Ok(Self { params, last: None })
    }

    /// Encoder reading for a wheel angle.
    fn counted(&self, angle: f64) -> f64 {
        match self.params.ticks_per_turn {
            None => angle,
            Some(ticks) => {
                let tick = TAU / f64::from(ticks);
                (angle / tick).floor() * tick
            }
        }
    }
}

impl SimulatedSensor for WheelOdometry {
    fn period_ms(&self) -> u32 {
        self.params.period_ms
    }

    fn sense(&mut self, moment: &TrueState<'_>, streams: &mut RandomStreams) -> Option<SensorReading> {
        let now = moment.wheel_angles.map(|angle| self.counted(angle));
        let last = self.last.replace(now)?;
        let [left, right] = [0, 1].map(|k| {
            let noise = self.params.travel_sigma_share
                * deviate::normal(streams.of(RandomStreamPurpose::OdometryNoise));
            (now[k] - last[k]) * self.params.wheel_radius_m * (1.0 + noise)
        });
        let (travel, turn) = (0.5 * (left + right), (right - left) / self.params.wheel_separation_m);
        let seconds = f64::from(self.params.period_ms) * 1e-3;
        Some(match self.params.encoding {
            OdometryEncoding::Velocity => SensorReading {
                data: RecordData::Velocity(Velocity { linear: travel / seconds, angular: turn / seconds }),
                stamp_offset_ms: -i64::from(self.params.period_ms),
            },
            OdometryEncoding::Increment => {
                let step = plane::advance(&Pose2::new(0.0, 0.0, 0.0), travel, turn);
                SensorReading { data: RecordData::OdometryIncrement(step), stamp_offset_ms: 0 }
            }
        })
    }
}
