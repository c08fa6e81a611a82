//! ROS 2 bags through the binary.

#![expect(clippy::unwrap_used, reason = "a panic is the verdict of a test, in its helpers too")]

use std::{fs, path::PathBuf};

use wayfix_sensor_log::{LogFormat, LogOpenOptions, Record, RecordData, Stamp, Velocity, open, write};

use crate::common::{Outcome, wayfix};

/// A drive in a room of 8 m by 6 m, recorded with the Python package rosbags (xtask/clients/ros_bags.py): the laser hangs head down, turned
/// by 0.5 rad, and odometry says 5 % too much.
fn bag() -> PathBuf {
    PathBuf::from(env!("CARGO_MANIFEST_DIR")).join("../sensor-log/tests/data/ros2_drive.mcap")
}

/// A wall whose middle has not been seen yet is two pieces.
const FOUR_WALLS: std::ops::RangeInclusive<f64> = 4.0..=8.0;

fn with_bag(command: &[&str], more: &[&str]) -> Outcome {
    let bag = bag();
    wayfix(command.iter().chain(&[bag.to_str().unwrap()]).chain(more))
}

#[test]
fn info_names_every_topic_and_what_becomes_of_it() {
    let outcome = with_bag(&["info"], &[]);
    assert_eq!(outcome.code, 0, "{}", outcome.stderr);
    let line =
        |topic: &str| outcome.stdout.lines().find(|line| line.trim().starts_with(topic)).unwrap_or_default();
    assert!(line("/scan ").ends_with("laser scan"), "{}", outcome.stdout);
    assert!(line("/scan_rear ").contains("--topic /scan_rear"), "{}", outcome.stdout);
    assert!(line("/chatter ").ends_with("not understood"), "{}", outcome.stdout);
    assert!(
        outcome.stdout.contains("usable for `wayfix run slam`, with figures of accuracy"),
        "{}",
        outcome.stdout
    );
}

#[test]
fn bag_walls_correct_odometry_with_the_mount_of_its_transform() {
    let slam = ["run", "slam", "--json", "--log"];
    let placed = with_bag(&slam, &[]);
    // 5 % of a circle of 1.5 m: some centimetres. The walls are seen without noise, so what is left of it is little.
    let odometry = placed.metric("dead_reckoning_aligned_rmse_m");
    assert!(placed.metric("ate_rmse_m") < 0.25 * odometry, "{}", placed.stdout);
    assert!(FOUR_WALLS.contains(&placed.metric("n_landmarks")), "{}", placed.stdout);

    let folder = tempfile::tempdir().unwrap();
    let params = folder.path().join("middle.toml");
    fs::write(&params, "laser_pose = [0.0, 0.0, 0.0]\n").unwrap();
    let misplaced = with_bag(&slam, &["--params", params.to_str().unwrap()]);
    assert!(misplaced.metric("ate_rmse_m") > 4.0 * placed.metric("ate_rmse_m"), "{}", misplaced.stdout);
}

#[test]
fn a_robot_that_tells_its_velocity_only_maps_the_same_walls() {
    // What the bag says by increments, this log says by the velocity of the circle: 0.5 m/s, and 0.5 / 1.5 rad/s.
    let velocity = RecordData::Velocity(Velocity { linear: 0.5, angular: 0.5 / 1.5 });
    let is_first = |stamp: &mut Option<Stamp>, now: Stamp| stamp.replace(now) != Some(now);
    let mut last = None;
    let records = open(bag(), &LogOpenOptions::default()).unwrap().flat_map(|record| {
        let told = Record { stamp: record.stamp, data: velocity.clone() };
        let told = is_first(&mut last, record.stamp).then_some(told);
        let kept = (!matches!(record.data, RecordData::OdometryIncrement(_))).then_some(record);
        told.into_iter().chain(kept)
    });
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("velocities.mcap");
    write(&path, LogFormat::Mcap, records).unwrap();
    let outcome = wayfix(["run", "slam", "--json", "--log", path.to_str().unwrap()]);
    assert!(FOUR_WALLS.contains(&outcome.metric("n_landmarks")), "{}", outcome.stdout);
    let info = wayfix(["info", path.to_str().unwrap()]);
    assert!(info.stdout.contains("usable for `wayfix run slam`, with figures"), "{}", info.stdout);
}

#[test]
fn lines_are_found_in_the_laser_that_is_asked_for() {
    let lines = ["run", "lines", "--json", "--log"];
    let front = with_bag(&lines, &[]);
    assert_eq!((front.metric("n_scans"), front.metric("n_skipped")), (27.0, 0.0));
    // Without noise, less than the centimetre that is expected of a laser; an echo in a corner may be on the wrong wall.
    assert!(front.metric("residual_rms_m") < 0.01, "{}", front.stdout);
    // The rear one sees nothing, which is no result.
    let rear = with_bag(&lines, &["--topic", "/scan_rear"]);
    assert_eq!((rear.code, rear.stdout.as_str()), (1, ""));
    assert!(rear.stderr.contains("no laser scan could be used"), "{}", rear.stderr);
    let wrong = with_bag(&lines, &["--topic", "/laser"]);
    assert_eq!((wrong.code, wrong.stdout.as_str()), (1, ""));
    assert!(
        wrong.stderr.contains("\"/laser\"") && wrong.stderr.contains("/scan_rear (sensor_msgs"),
        "{}",
        wrong.stderr
    );
}

#[test]
fn raw_bag_images_reach_the_colour_report() {
    let map = concat!(env!("CARGO_MANIFEST_DIR"), "/../../fixtures/four-legged-field.toml");
    let folder = tempfile::tempdir().unwrap();
    let out = folder.path().to_str().unwrap();
    let outcome = with_bag(&["run", "color", "--json", "--map", map, "--out", out, "--log"], &[]);
    // The pictures show no field: what is asked for is that every one was used, and that pages can show them.
    assert_eq!(outcome.metric("n_frames"), 3.0, "{}", outcome.stderr);
    let page = fs::read_to_string(folder.path().join("index.html")).unwrap();
    assert!(page.contains("data:image/png;base64,") && !page.contains("x-portable-anymap"));
}

#[test]
fn a_converted_bag_gives_the_same_map() {
    let folder = tempfile::tempdir().unwrap();
    let converted = folder.path().join("drive.mcap");
    let converted = converted.to_str().unwrap();
    assert_eq!(with_bag(&["convert"], &[converted]).code, 0);
    let slam = ["run", "slam", "--json", "--log"];
    let again = wayfix(slam.iter().chain(&[converted]));
    assert_eq!(again.figures(), with_bag(&slam, &[]).figures());
}
