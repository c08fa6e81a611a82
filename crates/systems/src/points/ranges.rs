use std::ops::RangeInclusive;

use wayfix_slam_ekf::{JointCompatibility, LandmarkConfirmationParams, NearestNeighbour, SlamError};

use super::PointSlamParams;
use crate::{settings::number, slam::increment_numbers};

/// What a parameter may be, for the machine and in words.
type Range = (RangeInclusive<f64>, &'static str);

/// Beyond a minute a delay is a wrong unit.
const DELAY: Range = (0.0..=60.0, "from 0 to 60 s");
/// Squares of what is larger would not fit beside the others in one covariance.
const NOT_NEGATIVE: Range = (0.0..=1e6, "from 0 to 1e6");
/// A sensor without noise leaves nothing to invert.
const SENSOR_NOISE: Range = (1e-9..=1e6, "from 1e-9 to 1e6");
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
    /// use wayfix_systems::points::{PointSlamParams, RobotProfile};
    /// let mut params = PointSlamParams::of(RobotProfile::Generic).validated()?;
    /// params.sensor.bearing_sigma = -0.01;
    /// let error = params.validated().unwrap_err().to_string();
    /// assert_eq!(error, "parameter sensor.bearing_sigma is -0.01, must be from 1e-9 to 1e6");
    /// # Ok::<(), wayfix_slam_ekf::SlamError>(())
    /// ```
    ///
    /// # Errors
    /// [`SlamError::Parameter`] for the first that is not.
    pub fn validated(self) -> Result<Self, SlamError> {
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
            number!(mounting.sensor_heading, PLACE),
            number!(mounting.antenna_x, PLACE),
            number!(mounting.antenna_y, PLACE),
            number!(vehicle.wheel_base, WHEEL_BASE),
            number!(vehicle.wheel_offset, PLACE),
            number!(sensor.range_sigma, NOT_NEGATIVE),
            number!(sensor.range_sigma_per_meter, NOT_NEGATIVE),
            ("sensor.range_sigma at one metre", nearest_range_sigma, SENSOR_NOISE),
            number!(sensor.bearing_sigma, SENSOR_NOISE),
            number!(in "sensor", correlated_noise.independent_range_sigma, NOT_NEGATIVE),
            number!(in "sensor", correlated_noise.independent_range_sigma_per_meter, NOT_NEGATIVE),
            (
                "sensor.correlated_noise.independent_range_sigma at one metre",
                nearest_own_range_sigma,
                SENSOR_NOISE,
            ),
            number!(in "sensor", correlated_noise.independent_bearing_sigma, SENSOR_NOISE),
            number!(in "sensor", correlated_noise.common_range_sigma_per_meter, NOT_NEGATIVE),
            number!(in "sensor", correlated_noise.common_bearing_sigma, NOT_NEGATIVE),
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

#[cfg(test)]
mod tests {
    use super::*;
    use crate::points::RobotProfile;

    /// Every number of the parameters, by its path in the file.
    fn numbers(prefix: &str, table: &toml::Table, found: &mut Vec<String>) {
        for (key, value) in table {
            let path = format!("{prefix}{key}");
            match value {
                toml::Value::Table(table) => numbers(&format!("{path}."), table, found),
                toml::Value::Float(_) => found.push(path),
                _ => {}
            }
        }
    }

    fn with(path: &str, value: &str) -> PointSlamParams {
        PointSlamParams::from_toml(&format!("{path} = {value}"), RobotProfile::Utias).unwrap()
    }

    #[test]
    fn no_number_may_be_nan_or_negative_and_the_error_names_it() {
        let mut paths = Vec::new();
        let all = toml::Table::try_from(PointSlamParams::of(RobotProfile::Utias)).unwrap();
        numbers("", &all, &mut paths);
        assert!(paths.len() > 20, "{paths:?}");
        let in_the_filter = ["filter.gate_probability", "filter.student_t_degrees_of_freedom"];
        for path in paths.iter().filter(|path| !in_the_filter.contains(&path.as_str())) {
            let may_be_negative = path.starts_with("mounting.") || path == "vehicle.wheel_offset";
            let low = if may_be_negative { "-1e4" } else { "-1.0" };
            for value in ["nan", low, "-inf"] {
                let Err(SlamError::Parameter { name, .. }) = with(path, value).validated() else {
                    panic!("{path} = {value} passes");
                };
                let key = path.rsplit('.').next().unwrap();
                assert!(name.ends_with(key), "{name} is not {path}");
            }
        }
    }

    #[test]
    fn the_defaults_of_every_profile_are_in_range() {
        for profile in [
            RobotProfile::Generic,
            RobotProfile::RangeBearing,
            RobotProfile::VictoriaPark,
            RobotProfile::Utias,
        ] {
            assert!(PointSlamParams::of(profile).validated().is_ok());
        }
    }

    #[test]
    fn a_sensor_without_noise_is_refused() {
        let text = "[sensor]\nrange_sigma = 0.0\nrange_sigma_per_meter = 0.0";
        let params = PointSlamParams::from_toml(text, RobotProfile::Generic).unwrap();
        assert!(matches!(params.validated(), Err(SlamError::Parameter { value: 0.0, .. })));
    }
}
