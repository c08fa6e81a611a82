//! Parameters of EKF-SLAM with points: each number has a range, and an error names it.

#![allow(clippy::unwrap_used, clippy::panic, reason = "a panic is the verdict of a test, in its helpers too")]

use wayfix_slam_ekf::SlamError;
use wayfix_slam_system::points::{PointSlamParams, RobotProfile};

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
    for profile in
        [RobotProfile::Generic, RobotProfile::RangeBearing, RobotProfile::VictoriaPark, RobotProfile::Utias]
    {
        assert!(PointSlamParams::of(profile).validated().is_ok());
    }
}

#[test]
fn a_sensor_without_noise_is_refused() {
    let text = "[sensor]\nrange_sigma = 0.0\nrange_sigma_per_meter = 0.0";
    let params = PointSlamParams::from_toml(text, RobotProfile::Generic).unwrap();
    assert!(matches!(params.validated(), Err(SlamError::Parameter { value: 0.0, .. })));
}
