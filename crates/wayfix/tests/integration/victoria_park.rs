//! `wayfix run slam` on a car: a folder in the format of the Victoria Park set, driven here without any noise.

#![expect(clippy::unwrap_used, reason = "a panic is the verdict of a test, in its helpers too")]

use approx::abs_diff_eq;
use nalgebra::{Vector2, Vector3};
use std::{
    f64::consts::{FRAC_PI_2, TAU},
    fmt::Write,
    path::{Path, PathBuf},
};
use wayfix_estimation_traits::{LieGroup, Pose2};

use crate::common::{Scratch, run_slam, wayfix};

/// Seconds between looks; fixes come with them, odometry eight times as often.
const PERIOD: f64 = 0.2;
const WHEEL_SPEED: f64 = 3.0;
const STEERING: f64 = 0.2;
/// Laser and antenna, from the middle of the rear axle.
const MAST: [f64; 2] = [3.78, 0.5];
/// Nothing errs but rounding: 1e-6 m leaves room for some hundred linear solves and none for a wrong model.
const ROUNDING: f64 = 1e-6;

/// Where the car is: a left turn from (−30, 20), facing 1 rad. [Guivant & Nebot 2001, Eqs. 1-3]
fn pose(seconds: f64) -> Pose2<f64> {
    let (wheel_base, wheel_offset) = (2.83, 0.76);
    let speed = WHEEL_SPEED / (1.0 - STEERING.tan() * wheel_offset / wheel_base);
    let turn = speed * STEERING.tan() / wheel_base;
    Pose2::new(-30.0, 20.0, 1.0).compose(&Pose2::exp(&Vector3::new(speed * seconds, 0.0, turn * seconds)))
}

/// Nine trees around the circle that the car drives.
fn trees() -> impl Iterator<Item = Vector2<f64>> {
    let centre = (pose(0.0).translation + pose(14.0).translation) * 0.5; // half a lap takes 13.8 s
    (0..9).map(move |k| {
        let angle = TAU * f64::from(k) / 9.0;
        centre + Vector2::new(angle.cos(), angle.sin()) * (22.0 + f64::from(k % 3))
    })
}

/// The set as a folder: `n_looks` looks, with or without GPS.
fn folder(scratch: &Scratch, name: &str, n_looks: u32, with_fixes: bool) -> PathBuf {
    let mut odometry = "t_s,speed_mps,steering_rad\n".to_owned();
    let mut looks = "t_s,range_m,bearing_rad,diameter_m\n".to_owned();
    let mut fixes = "t_s,x_m,y_m\n".to_owned();
    for row in 0..8 * n_looks {
        writeln!(odometry, "{:.3},{WHEEL_SPEED},{STEERING}", 100.0 + PERIOD / 8.0 * f64::from(row)).unwrap();
    }
    for look in 0..n_looks {
        let pose = pose(PERIOD * f64::from(look));
        let time = 100.0 + PERIOD * f64::from(look);
        let antenna = pose.transform(&MAST.into());
        writeln!(fixes, "{time:.3},{},{}", antenna.x, antenna.y).unwrap();
        for tree in trees() {
            let seen = pose.inverse_transform(&tree) - Vector2::from(MAST);
            let (range, bearing) = (seen.norm(), seen.y.atan2(seen.x));
            if range < 29.0 && bearing.abs() < 1.3 {
                writeln!(looks, "{time:.3},{range},{},0.3", bearing + FRAC_PI_2).unwrap();
            }
        }
    }
    scratch.file(&format!("{name}/odometry.csv"), odometry);
    scratch.file(&format!("{name}/trees.csv"), looks);
    if with_fixes {
        scratch.file(&format!("{name}/gps.csv"), fixes);
    }
    scratch.path(name)
}

#[test]
fn victoria_park_starts_at_the_pose_that_fits_the_first_fixes() {
    let scratch = Scratch::new();
    let set = folder(&scratch, "set", 200, true);
    for association in ["nn", "jcbb"] {
        let outcome = run_slam(&set, &["--association", association]);
        for figure in ["ate_rmse_m", "ate_aligned_rmse_m", "dead_reckoning_aligned_rmse_m"] {
            assert!(outcome.metric(figure) < ROUNDING, "{association}, {figure}: {}", outcome.metric(figure));
        }
        assert_eq!(outcome.metric("n_landmarks"), 9.0, "{association}");
        assert_eq!(outcome.event("record_refused"), 0);
    }
}

#[test]
fn the_antenna_and_not_the_axle_is_compared_with_the_fixes() {
    let scratch = Scratch::new();
    let set = folder(&scratch, "set", 100, true);
    let params = scratch.file("params.toml", "[mounting]\nantenna_x = 0.0\nantenna_y = 0.0\n");
    // Axle and mast turn about the same point at 13.96 m and 13.98 m: a fit hides all of the 3.8 m between them but these two centimetres.
    let outcome = run_slam(&set, &["--params", params.to_str().unwrap()]);
    assert!(outcome.metric("ate_aligned_rmse_m") > 1e3 * ROUNDING, "{}", outcome.stdout);
}

#[test]
fn a_start_that_is_given_goes_before_the_fit() {
    let scratch = Scratch::new();
    let set = folder(&scratch, "set", 60, true);
    let params = scratch.file("params.toml", "start_pose = [-29.0, 20.0, 1.0]\n"); // a metre beside
    let outcome = run_slam(&set, &["--params", params.to_str().unwrap()]);
    assert!(abs_diff_eq!(outcome.metric("ate_rmse_m"), 1.0, epsilon = ROUNDING), "{}", outcome.stdout);
    assert!(outcome.metric("ate_aligned_rmse_m") < ROUNDING);
}

#[test]
fn without_fixes_there_is_a_map_and_no_error() {
    let scratch = Scratch::new();
    let outcome = run_slam(&folder(&scratch, "set", 200, false), &[]);
    assert_eq!(outcome.metric("n_landmarks"), 9.0);
    assert!(outcome.json()["metrics"].get("ate_rmse_m").is_none());
}

#[test]
fn a_car_in_mcap_is_the_same_car() {
    let scratch = Scratch::new();
    let (set, mcap) = (folder(&scratch, "set", 60, true), scratch.path("set.mcap"));
    let converted = wayfix([Path::new("convert"), &set, &mcap]);
    assert_eq!(converted.code, 0, "{}", converted.stderr);
    assert_eq!(run_slam(&mcap, &[]).figures(), run_slam(&set, &[]).figures());
}
