//! `wayfix run slam` on CARMEN logs whose laser is ahead of the robot, through the binary.

#![expect(clippy::unwrap_used, reason = "a panic is the verdict of a test, in its helpers too")]

use std::fs;

use wayfix_estimation_traits::{LieGroup, Pose2};

use crate::common::{Outcome, Scratch, wayfix};

/// Where the laser is ahead of the robot, m.
const AHEAD: f64 = 0.4;

/// A quarter of a circle in a room of 8 m by 6 m whose corner is the origin.
fn truth() -> Vec<Pose2<f64>> {
    let pose = |k: usize| {
        let turned = std::f64::consts::FRAC_PI_2 * k as f64 / 60.0;
        Pose2::new(3.0 + 2.0 * turned.sin(), 1.5 + 2.0 * (1.0 - turned.cos()), turned)
    };
    (0..=60).map(pose).collect()
}

/// How far it is from the laser to the wall that a beam meets.
fn range(laser: &Pose2<f64>, bearing: f64) -> f64 {
    let (sin, cos) = (laser.heading() + bearing).sin_cos();
    let to = |from: f64, size: f64, rate: f64| match rate {
        rate if rate > 0.0 => (size - from) / rate,
        rate if rate < 0.0 => -from / rate,
        _ => f64::INFINITY,
    };
    to(laser.x(), 8.0, cos).min(to(laser.y(), 6.0, sin))
}

/// The drive as `FLASER` or `ROBOTLASER1` lines, with odometry that turns 5 % too little.
fn log(is_front: impl Fn(usize) -> bool) -> String {
    let shown = |pose: &Pose2<f64>| format!("{:.6} {:.6} {:.6}", pose.x(), pose.y(), pose.heading());
    let mount = Pose2::new(AHEAD, 0.0, 0.0);
    let truth = truth();
    let mut odometry = truth[0];
    let mut text = String::new();
    for (k, pose) in truth.iter().enumerate() {
        if let Some(before) = k.checked_sub(1).map(|before| truth[before]) {
            let step = before.inverse().compose(pose);
            odometry = odometry.compose(&Pose2::new(step.x(), step.y(), 0.95 * step.heading()));
        }
        let laser = pose.compose(&mount);
        let ranges: String = (0..181)
            .map(|beam| format!("{:.3} ", range(&laser, (f64::from(beam) - 90.0).to_radians())))
            .collect();
        let poses = format!("{} {}", shown(&odometry.compose(&mount)), shown(&odometry));
        let t = 1000.0 + 0.1 * k as f64;
        text += &if is_front(k) {
            format!("FLASER 181 {ranges}{poses} {t:.6} host {t:.6}\n")
        } else {
            let stated = "0 -1.570796 3.141593 0.017453 80.0 0.01 0";
            format!("ROBOTLASER1 {stated} 181 {ranges}0 {poses} 0 0 0 0 0 {t:.6} host {t:.6}\n")
        };
    }
    text
}

/// The largest distance from the true path, once both begin at the same pose.
fn path_error(scratch: &Scratch, text: &str) -> (Outcome, f64) {
    let (log, out) = (scratch.file("drive.log", text), scratch.path("out"));
    let outcome =
        wayfix(["run", "slam", "--json", "--log", log.to_str().unwrap(), "--out", out.to_str().unwrap()]);
    let (estimates, path) = (out.join("estimates.mcap"), scratch.path("path.tum"));
    assert_eq!(wayfix(["convert", estimates.to_str().unwrap(), path.to_str().unwrap()]).code, 0);
    let rows = fs::read_to_string(path).unwrap();
    let poses: Vec<Pose2<f64>> = rows
        .lines()
        .map(|row| {
            let row: Vec<f64> = row.split_whitespace().map(|word| word.parse().unwrap()).collect();
            Pose2::new(row[1], row[2], 2.0 * row[6].atan2(row[7]))
        })
        .collect();
    let truth = truth();
    assert_eq!(poses.len(), truth.len());
    let to_truth = truth[0].compose(&poses[0].inverse());
    let error = |(pose, truth): (&Pose2<f64>, &Pose2<f64>)| {
        let pose = to_truth.compose(pose);
        (pose.x() - truth.x()).hypot(pose.y() - truth.y())
    };
    let largest = poses.iter().zip(&truth).map(error).fold(0.0, f64::max);
    (outcome, largest)
}

/// The mount that is not known costs 0.4 m over a quarter turn; the ranges are printed in millimetres.
const PATH_BOUND_M: f64 = 0.03;

#[test]
fn a_laser_ahead_in_carmen_gives_the_robots_path() {
    let scratch = Scratch::new();
    let (outcome, error) = path_error(&scratch, &log(|_| true));
    assert!(error < PATH_BOUND_M, "{error} m");
    assert_eq!(outcome.event("laser_mount_from_poses"), 1);
    // The poses are odometry: there is nothing to compare the path with.
    assert_eq!(outcome.event("poses_are_odometry"), 1);
    assert!(outcome.figures().iter().all(|(name, _)| !name.starts_with("ate") && !name.starts_with("nees")));
    assert!(outcome.stderr.contains("[0.400 m, 0.000 m, 0.000 rad]"), "{}", outcome.stderr);
}

#[test]
fn a_log_of_both_scan_messages_is_used_whole() {
    let scratch = Scratch::new();
    let (outcome, error) = path_error(&scratch, &("\u{feff}".to_owned() + &log(|k| k % 2 == 0)));
    assert!(error < PATH_BOUND_M, "{error} m");
    assert_eq!((outcome.event("keyframe_matched"), outcome.event("log_problem")), (60, 0));
}

#[test]
fn parameters_with_a_byte_order_mark_are_read() {
    let scratch = Scratch::new();
    let log = scratch.file("drive.log", log(|_| true));
    let log = log.to_str().unwrap();
    let marked = scratch.file("marked.toml", "\u{feff}laser_pose = [0.4, 0.0, 0.0]\r\n");
    let outcome = wayfix(["run", "slam", "--json", "--log", log, "--params", marked.to_str().unwrap()]);
    assert_eq!(outcome.code, 0, "{}", outcome.stderr);
    let utf16: Vec<u8> = "laser_pose = [0.4, 0.0, 0.0]".encode_utf16().flat_map(u16::to_le_bytes).collect();
    let utf16 = scratch.file("utf16.toml", utf16);
    let outcome = wayfix(["run", "slam", "--json", "--log", log, "--params", utf16.to_str().unwrap()]);
    assert!(outcome.code == 1 && outcome.stderr.contains("UTF-16"), "{}", outcome.stderr);
}
