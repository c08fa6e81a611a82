use std::f64::consts::TAU;

use nalgebra::Vector2;
use wayfix_appearance_cml::AppearanceMapError;
use wayfix_estimation_traits::{LieGroup, Pose2};
use wayfix_gaussian_core::ChiSquaredGate;
use wayfix_sensor_log::{PoseMeasurement, Stamp};
use wayfix_slam_ekf::{ExternalParams, MapMeasurement};
use wayfix_system_core::{EventCounts, HeadingSignTest, map_measurement};

use super::{CmlSystem, PanoramaLocalizer};

/// Probability with which a correct measurement passes the gate: the default of EKF-SLAM.
const GATE_PROBABILITY: f64 = 0.9999;

/// Other estimators of the pose. [Gross et al. 2005, Fig. 2]
#[derive(Default)]
pub(super) struct ExternalSensors {
    params: ExternalParams,
    last_increment: Option<Stamp>,
    /// Measurements that wait for the increment that leads beyond them.
    waiting: Vec<(Stamp, MapMeasurement)>,
    heading_sign: HeadingSignTest,
}

impl ExternalSensors {
    pub(super) fn new(params: ExternalParams) -> Self {
        Self { params, ..Self::default() }
    }
}

impl CmlSystem {
    /// Takes a measurement of the pose now, or with the increment that leads beyond it.
    pub(super) fn take_measurement(
        &mut self,
        stamp: Stamp,
        measured: &PoseMeasurement,
    ) -> Result<(), String> {
        if !self.external.params.is_on() {
            self.events.count("measurement_ignored");
            return Ok(());
        }
        let measurement = map_measurement(measured, &self.external.params, Vector2::zeros());
        let measurement = measurement.map_err(|error| error.to_string())?;
        if self.external.last_increment.is_some_and(|last| last < stamp) {
            self.external.waiting.push((stamp, measurement));
            return Ok(());
        }
        self.advance_to(stamp)?;
        self.correct(&measurement)
    }

    /// Moves the robot by an increment, with the measurements that wait for a part of it.
    pub(super) fn move_through(&mut self, stamp: Stamp, increment: &Pose2<f64>) -> Result<(), String> {
        let begin = self.external.last_increment.replace(stamp).unwrap_or(stamp);
        let seconds = stamp.seconds_since(begin).max(f64::MIN_POSITIVE);
        let (whole, mut done) = (increment.log(), 0.0);
        for (since, measurement) in std::mem::take(&mut self.external.waiting) {
            let share = (since.seconds_since(begin) / seconds).clamp(done, 1.0);
            self.move_by(&Pose2::exp(&(whole * (share - done))))?;
            done = share;
            if let Err(reason) = self.correct(&measurement) {
                self.events.refuse("record_refused", format!("measured pose of {since}: {reason}"));
            }
        }
        self.move_by(&if done > 0.0 { Pose2::exp(&(whole * (1.0 - done))) } else { *increment })
    }

    /// Takes the remaining measurements at the end of the log, and reports a wrong compass.
    pub(super) fn finish_measurements(&mut self) {
        for (since, measurement) in std::mem::take(&mut self.external.waiting) {
            if let Err(reason) = self.correct(&measurement) {
                self.events.refuse("record_refused", format!("measured pose of {since}: {reason}"));
            }
        }
        self.external.heading_sign.warn_if_mirrored(&mut self.events);
    }

    fn correct(&mut self, measurement: &MapMeasurement) -> Result<(), String> {
        let sign = &mut self.external.heading_sign;
        if !admit_heading(measurement, &self.localizer, sign, &mut self.events) {
            return Ok(());
        }
        let area = self.localizer.map().area();
        let gate =
            |degrees_of_freedom| ChiSquaredGate::from_probability(degrees_of_freedom, GATE_PROBABILITY);
        let localizer = &mut self.localizer;
        let corrected = match measurement {
            MapMeasurement::Position(sensor, position) => {
                gate(2).map(|gate| localizer.correct(sensor, position, &gate, area))
            }
            MapMeasurement::Heading(sensor, heading) => {
                gate(1).map(|gate| localizer.correct(sensor, heading, &gate, TAU))
            }
            MapMeasurement::Pose(sensor, pose) => {
                gate(3).map(|gate| localizer.correct(sensor, pose, &gate, area * TAU))
            }
        };
        match corrected.map_err(|error| error.to_string())? {
            Ok(events) => {
                self.events.count("measurement_accepted");
                events.iter().for_each(|event| self.count(event));
            }
            Err(outlier @ AppearanceMapError::Outlier { .. }) => {
                self.events.refuse("measurement_gated", format!("a measured pose is {outlier}"));
            }
            Err(AppearanceMapError::UnknownPose) => self.events.count("measurement_withheld"),
            Err(error) => return Err(error.to_string()),
        }
        Ok(())
    }
}

/// Whether a measurement is no heading, or one of a compass whose sign is known to be right; counts the others.
fn admit_heading(
    measurement: &MapMeasurement,
    localizer: &PanoramaLocalizer,
    sign: &mut HeadingSignTest,
    events: &mut EventCounts,
) -> bool {
    let MapMeasurement::Heading(sensor, measured) = measurement else { return true };
    let Some(pose) = localizer.estimate() else {
        events.count("measurement_withheld");
        return false;
    };
    let variance = pose.covariance().m33 + sensor.variance;
    sign.is_admitted(measured.radians(), pose.mean().heading(), variance, events)
}
