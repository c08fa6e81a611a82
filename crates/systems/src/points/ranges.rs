use std::ops::RangeInclusive;

use wayfix_slam_ekf::{ConfirmationParams, JointCompatibility, NearestNeighbour, SlamError};

use super::PointSlamParams;
use crate::slam::increment_numbers;

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
    /// use wayfix_systems::points::{PointSlamParams, Profile};
    /// let mut params = PointSlamParams::of(Profile::Generic).validated()?;
    /// params.sensor.bearing_sigma = -0.01;
    /// let error = params.validated().unwrap_err().to_string();
    /// assert_eq!(error, "parameter sensor.bearing_sigma is -0.01, must be from 1e-9 to 1e6");
    /// # Ok::<(), wayfix_slam_ekf::SlamError>(())
    /// ```
    ///
    /// # Errors
    /// [`SlamError::Parameter`] for the first that is not.
    pub fn validated(self) -> Result<Self, SlamError> {
        let Self { robot, mounting, vehicle, sensor, velocity, increment, filter, .. } = &self;
        let unlabelled_confirmation = &self.unlabelled_confirmation;
        NearestNeighbour::new(self.nearest_neighbour)?;
        JointCompatibility::new(self.joint_compatibility)?;
        let correlated_noise = sensor.correlated_noise.unwrap_or_default();
        let merging = filter.merging.unwrap_or_default();
        let nearest_own_range_sigma =
            correlated_noise.independent_range_sigma + correlated_noise.independent_range_sigma_per_meter;
        let nearest_range_sigma = sensor.range_sigma + sensor.range_sigma_per_meter;
        let times_seen = |confirmation: &ConfirmationParams| confirmation.n_detections as f64;
        for (name, value, (range, words)) in [
            ("robot.sensor_latency", robot.sensor_latency, DELAY),
            ("robot.command_delay", robot.command_delay, DELAY),
            ("robot.turn_command_shortening", robot.turn_command_shortening, DELAY),
            ("robot.velocity_hold", robot.velocity_hold, NOT_NEGATIVE),
            ("robot.range_scale_sigma", robot.range_scale_sigma, NOT_NEGATIVE),
            ("mounting.sensor_x", mounting.sensor_x, PLACE),
            ("mounting.sensor_y", mounting.sensor_y, PLACE),
            ("mounting.sensor_heading", mounting.sensor_heading, PLACE),
            ("mounting.antenna_x", mounting.antenna_x, PLACE),
            ("mounting.antenna_y", mounting.antenna_y, PLACE),
            ("vehicle.wheel_base", vehicle.wheel_base, WHEEL_BASE),
            ("vehicle.wheel_offset", vehicle.wheel_offset, PLACE),
            ("sensor.range_sigma", sensor.range_sigma, NOT_NEGATIVE),
            ("sensor.range_sigma_per_meter", sensor.range_sigma_per_meter, NOT_NEGATIVE),
            ("sensor.range_sigma at one metre", nearest_range_sigma, SENSOR_NOISE),
            ("sensor.bearing_sigma", sensor.bearing_sigma, SENSOR_NOISE),
            (
                "sensor.correlated_noise.independent_range_sigma",
                correlated_noise.independent_range_sigma,
                NOT_NEGATIVE,
            ),
            (
                "sensor.correlated_noise.independent_range_sigma_per_meter",
                correlated_noise.independent_range_sigma_per_meter,
                NOT_NEGATIVE,
            ),
            (
                "sensor.correlated_noise.independent_range_sigma at one metre",
                nearest_own_range_sigma,
                SENSOR_NOISE,
            ),
            (
                "sensor.correlated_noise.independent_bearing_sigma",
                correlated_noise.independent_bearing_sigma,
                SENSOR_NOISE,
            ),
            (
                "sensor.correlated_noise.common_range_sigma_per_meter",
                correlated_noise.common_range_sigma_per_meter,
                NOT_NEGATIVE,
            ),
            (
                "sensor.correlated_noise.common_bearing_sigma",
                correlated_noise.common_bearing_sigma,
                NOT_NEGATIVE,
            ),
            ("filter.merging.separation", merging.separation, NOT_NEGATIVE),
            ("filter.merging.n_sigmas", merging.n_sigmas, NOT_NEGATIVE),
            ("sensor.sensor_range", sensor.sensor_range, THRESHOLD),
            ("sensor.half_field_of_view", sensor.half_field_of_view, THRESHOLD),
            ("velocity.linear_sigma", velocity.linear_sigma, NOT_NEGATIVE),
            ("velocity.angular_sigma", velocity.angular_sigma, NOT_NEGATIVE),
            ("velocity.turning_sigma", velocity.turning_sigma, NOT_NEGATIVE),
            ("velocity.linear_sigma_per_meter", velocity.linear_sigma_per_meter, NOT_NEGATIVE),
            ("velocity.angular_sigma_per_meter", velocity.angular_sigma_per_meter, NOT_NEGATIVE),
            ("velocity.standing_factor", velocity.standing_factor, NOT_NEGATIVE),
            ("velocity.speed_loss_in_turns", velocity.speed_loss_in_turns, NOT_NEGATIVE),
            ("filter.confirmation.min_detection_rate", filter.confirmation.min_detection_rate, SHARE),
            ("unlabelled_confirmation.min_detection_rate", unlabelled_confirmation.min_detection_rate, SHARE),
            ("filter.confirmation.n_detections", times_seen(&filter.confirmation), TIMES_SEEN),
            ("filter.confirmation.restart_nis", filter.confirmation.restart_nis, THRESHOLD),
            ("unlabelled_confirmation.n_detections", times_seen(unlabelled_confirmation), TIMES_SEEN),
            ("unlabelled_confirmation.restart_nis", unlabelled_confirmation.restart_nis, THRESHOLD),
        ]
        .into_iter()
        .chain(increment_numbers(increment).map(|(name, value)| (name, value, NOT_NEGATIVE)))
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
    use crate::points::Profile;

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
        PointSlamParams::from_toml(&format!("{path} = {value}"), Profile::Utias).unwrap()
    }

    #[test]
    fn no_number_may_be_nan_or_negative_and_the_error_names_it() {
        let mut paths = Vec::new();
        let all = toml::Table::try_from(PointSlamParams::of(Profile::Utias)).unwrap();
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
        for profile in [Profile::Generic, Profile::RangeBearing, Profile::VictoriaPark, Profile::Utias] {
            assert!(PointSlamParams::of(profile).validated().is_ok());
        }
    }

    #[test]
    fn a_sensor_without_noise_is_refused() {
        let text = "[sensor]\nrange_sigma = 0.0\nrange_sigma_per_meter = 0.0";
        let params = PointSlamParams::from_toml(text, Profile::Generic).unwrap();
        assert!(matches!(params.validated(), Err(SlamError::Parameter { value: 0.0, .. })));
    }
}
