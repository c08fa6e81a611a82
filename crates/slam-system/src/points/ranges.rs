use std::{
    f64::consts::{PI, TAU},
    ops::RangeInclusive,
};

use wayfix_slam_ekf::{JointCompatibility, LandmarkConfirmationParams, NearestNeighbour, SlamError};

use super::PointSlamParams;
use crate::slam::{increment_numbers, number};

/// What a parameter may be, for the machine and in words.
type Range = (RangeInclusive<f64>, &'static str);

/// Beyond a minute a delay is a wrong unit.
const DELAY: Range = (0.0..=60.0, "from 0 to 60 s");
/// Squares of what is larger would not fit beside the others in one covariance.
const NOT_NEGATIVE: Range = (0.0..=1e6, "from 0 to 1e6");
/// A sensor without noise leaves nothing to invert.
const SENSOR_NOISE: Range = (1e-9..=1e6, "from 1e-9 to 1e6");
/// A standard deviation of an angle.
const ANGLE_NOISE: Range = (1e-9..=PI, "from 1e-9 to π rad");
const COMMON_ANGLE_NOISE: Range = (0.0..=PI, "from 0 to π rad");
/// Beyond a turn an angle is in degrees.
const ANGLE: Range = (-TAU..=TAU, "from -2π to 2π rad");
const TIMES_SEEN: Range = (1.0..=1e6, "from 1 to 1e6");
/// No robot is larger than a kilometre.
const PLACE: Range = (-1e3..=1e3, "from -1000 to 1000");
const WHEEL_BASE: Range = (1e-3..=1e3, "from 0.001 to 1000 m");
const SHARE: Range = (0.0..=1.0, "from 0 to 1");
const THRESHOLD: Range = (f64::MIN_POSITIVE..=f64::INFINITY, "positive");

impl PointSlamParams {
    /// The same parameters, when each is within its range.
    ///
    /// ```
    /// use wayfix_slam_system::points::{PointSlamParams, RobotProfile};
    /// let mut params = PointSlamParams::of(RobotProfile::Generic).validated()?;
    /// params.sensor.bearing_sigma = -0.01;
    /// let error = params.validated().unwrap_err().to_string();
    /// assert_eq!(error, "parameter sensor.bearing_sigma is -0.01, must be from 1e-9 to π rad");
    /// # Ok::<(), wayfix_slam_ekf::SlamError>(())
    /// ```
    ///
    /// # Errors
    /// [`SlamError::Parameter`] for the first that is not.
    pub fn validated(self) -> Result<Self, SlamError> {
        self.external.check()?;
        let Self { robot, mounting, vehicle, sensor, velocity_noise, increment_noise, filter, .. } = &self;
        let unlabelled_confirmation = &self.unlabelled_confirmation;
        NearestNeighbour::new(self.nearest_neighbour)?;
        JointCompatibility::new(self.joint_compatibility)?;
        let correlated_noise = sensor.correlated_noise.unwrap_or_default();
        let merging = filter.merging.unwrap_or_default();
        let nearest_own_range_sigma =
            correlated_noise.independent_range_sigma + correlated_noise.independent_range_sigma_per_meter;
        let nearest_range_sigma = sensor.range_sigma + sensor.range_sigma_per_meter;
        let times_seen = |confirmation: &LandmarkConfirmationParams| confirmation.min_detections as f64;
        for (name, value, (range, words)) in [
            number!(robot.sensor_latency, DELAY),
            number!(robot.command_delay, DELAY),
            number!(robot.turn_command_time_loss, DELAY),
            number!(robot.velocity_timeout, NOT_NEGATIVE),
            number!(robot.range_scale_sigma, NOT_NEGATIVE),
            number!(mounting.sensor_x, PLACE),
            number!(mounting.sensor_y, PLACE),
            number!(mounting.sensor_heading, ANGLE),
            number!(mounting.antenna_x, PLACE),
            number!(mounting.antenna_y, PLACE),
            ("start_pose (heading)", self.start_pose.map_or(0.0, |[.., heading]| heading), ANGLE),
            number!(vehicle.wheel_base, WHEEL_BASE),
            number!(vehicle.wheel_offset, PLACE),
            number!(sensor.range_sigma, NOT_NEGATIVE),
            number!(sensor.range_sigma_per_meter, NOT_NEGATIVE),
            ("sensor.range_sigma at one metre", nearest_range_sigma, SENSOR_NOISE),
            number!(sensor.bearing_sigma, ANGLE_NOISE),
            number!(in "sensor", correlated_noise.independent_range_sigma, NOT_NEGATIVE),
            number!(in "sensor", correlated_noise.independent_range_sigma_per_meter, NOT_NEGATIVE),
            (
                "sensor.correlated_noise.independent_range_sigma at one metre",
                nearest_own_range_sigma,
                SENSOR_NOISE,
            ),
            number!(in "sensor", correlated_noise.independent_bearing_sigma, ANGLE_NOISE),
            number!(in "sensor", correlated_noise.common_range_sigma_per_meter, NOT_NEGATIVE),
            number!(in "sensor", correlated_noise.common_bearing_sigma, COMMON_ANGLE_NOISE),
            number!(in "filter", merging.min_separation, NOT_NEGATIVE),
            number!(in "filter", merging.n_sigmas, NOT_NEGATIVE),
            number!(sensor.sensor_range, THRESHOLD),
            number!(sensor.half_field_of_view, THRESHOLD),
            number!(velocity_noise.linear_sigma, NOT_NEGATIVE),
            number!(velocity_noise.angular_sigma, NOT_NEGATIVE),
            number!(velocity_noise.turning_sigma, NOT_NEGATIVE),
            number!(velocity_noise.linear_sigma_per_meter, NOT_NEGATIVE),
            number!(velocity_noise.angular_sigma_per_meter, NOT_NEGATIVE),
            number!(velocity_noise.standing_factor, NOT_NEGATIVE),
            number!(velocity_noise.speed_loss_in_turns, NOT_NEGATIVE),
            number!(filter.confirmation.min_detection_rate, SHARE),
            number!(unlabelled_confirmation.min_detection_rate, SHARE),
            ("filter.confirmation.min_detections", times_seen(&filter.confirmation), TIMES_SEEN),
            number!(filter.confirmation.tentative_restart_nis, THRESHOLD),
            ("unlabelled_confirmation.min_detections", times_seen(unlabelled_confirmation), TIMES_SEEN),
            number!(unlabelled_confirmation.tentative_restart_nis, THRESHOLD),
        ]
        .into_iter()
        .chain(increment_numbers(increment_noise).map(|(name, value)| (name, value, NOT_NEGATIVE)))
        {
            if !range.contains(&value) {
                return Err(SlamError::Parameter { name, value, range: words });
            }
        }
        Ok(self)
    }
}
