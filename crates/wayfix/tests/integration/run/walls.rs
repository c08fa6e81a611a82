//! `wayfix run slam` on logs of laser scans, through the binary.
#![allow(clippy::unwrap_used, clippy::panic, reason = "a test that cannot run the command has failed")]

use std::{fs, path::PathBuf};

use assert_cmd::Command;
use serde_json::Value;

fn office() -> PathBuf {
    PathBuf::from(env!("CARGO_MANIFEST_DIR")).join("../../fixtures/office_laser.mcap")
}

fn wayfix(arguments: &[&str]) -> Command {
    let mut command = Command::cargo_bin("wayfix").unwrap();
    command.args(["run", "slam"]).args(arguments);
    command
}

fn metrics(arguments: &[&str]) -> Value {
    let output = wayfix(arguments).arg("--json").output().unwrap();
    assert!(output.status.success(), "{}", String::from_utf8_lossy(&output.stderr));
    serde_json::from_slice::<Value>(&output.stdout).unwrap()["metrics"].clone()
}

fn refusal(arguments: &[&str]) -> String {
    let output = wayfix(arguments).output().unwrap();
    assert!(!output.status.success() && output.stdout.is_empty());
    String::from_utf8(output.stderr).unwrap()
}

#[test]
fn the_robot_comes_home_and_the_walls_are_where_they_are() {
    let log = office();
    let metrics = metrics(&["--log", log.to_str().unwrap()]);
    let figure = |name: &str| metrics[name].as_f64().unwrap_or_else(|| panic!("{name} is missing"));
    // Odometry alone is metres off after the loop; a wall is seen to a centimetre or two.
    assert!(figure("dead_reckoning_aligned_rmse_m") > 5.0 && figure("end_position_error_m") < 0.1);
    assert!(figure("ate_rmse_m") < 0.3);
    // 95.45 % within two sigma, less two deviations of as many coin tosses.
    let share = 0.9545;
    let slack = 2.0 * (share * (1.0 - share) / figure("n_true_walls_found")).sqrt();
    assert!(figure("walls_within_2_sigma_share") > share - slack && figure("n_true_walls_found") > 30.0);
}

#[test]
fn printed_wall_parameters_round_trip() {
    let folder = tempfile::tempdir().unwrap();
    let log = office();
    let log = log.to_str().unwrap();
    let printed = wayfix(&["--log", log, "--print-params"]).output().unwrap().stdout;
    let path = folder.path().join("walls.toml");
    fs::write(&path, &printed).unwrap();
    assert!(String::from_utf8(printed).unwrap().contains("min_wall_length"));
    let decided = |metrics: Value| ["ate_rmse_m", "n_landmarks"].map(|name| metrics[name].clone());
    let again = decided(metrics(&["--log", log, "--params", path.to_str().unwrap()]));
    assert_eq!(again, decided(metrics(&["--log", log])));
}

/// Walls are seen from the robot alone: nothing tells where the floor lies as a whole. A wall that is known to be where it is ends two of the three.
#[test]
fn what_a_map_of_walls_cannot_know_is_named() {
    let folder = tempfile::tempdir().unwrap();
    let log = office();
    let log = log.to_str().unwrap();
    let free = |arguments: &[&str]| {
        metrics(&[&["--log", log, "--observability"], arguments].concat())["n_unobservable_directions"]
            .as_f64()
    };
    assert_eq!(free(&[]), Some(3.0));
    let path = folder.path().join("anchors.toml");
    fs::write(&path, "n_anchors = 1").unwrap();
    assert_eq!(free(&["--params", path.to_str().unwrap()]), Some(1.0), "along the one wall");
    assert!(metrics(&["--log", log])["n_unobservable_directions"].is_null());
}

#[test]
fn what_makes_no_sense_is_refused_by_name() {
    let folder = tempfile::tempdir().unwrap();
    let log = office();
    let log = log.to_str().unwrap();
    assert!(refusal(&["--log", log, "--association", "known"]).contains("--association nn or jcbb"));
    assert!(refusal(&["--log", log, "--profile", "utias"]).contains("--profile"));
    for (text, named) in [
        ("min_wall_length = nan", "min_wall_length"),
        ("[sensor]\nrho_sigma = -1.0", "rho_sigma"),
        ("[line_extraction]\nmin_points = 1", "min_points"),
        ("[sensor]\nrho = 1.0", "rho"),
        ("[sensor]\nsensor_range = nan", "sensor_range"),
        ("association = 'known'", "association"),
        ("[increment_noise]\nheading_variance_per_meter = -1.0", "heading_variance_per_meter"),
        ("laser_pose = [0.0, inf, 0.0]", "laser_pose"),
        ("[scan_match]\nkernel_m = 0.0", "robust_kernel_width_m"),
        ("[keyframes]\nmin_distance = -1.0", "keyframes.min_distance"),
        ("[odometry_noise_per_scan]\nheading_sigma = nan", "odometry_noise_per_scan.heading_sigma"),
    ] {
        let path = folder.path().join("params.toml");
        fs::write(&path, text).unwrap();
        let refusal = refusal(&["--log", log, "--params", path.to_str().unwrap()]);
        assert!(refusal.contains(named), "{text}: {refusal}");
    }
}
