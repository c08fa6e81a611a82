//! `run slam --estimator`: what the smoother takes, and what it refuses by name.

#![allow(clippy::unwrap_used, reason = "a panic is the verdict of a test, in its helpers too")]

use std::{fmt::Write, fs, path::Path};

use assert_cmd::Command;

fn fixture(name: &str) -> String {
    Path::new(env!("CARGO_MANIFEST_DIR")).join("../../fixtures").join(name).display().to_string()
}

fn run(arguments: &[&str]) -> (bool, String, String) {
    let output =
        Command::cargo_bin("wayfix").unwrap().args(["run", "slam"]).args(arguments).output().unwrap();
    let text = |bytes: Vec<u8>| String::from_utf8(bytes).unwrap();
    (output.status.success(), text(output.stdout), text(output.stderr))
}

#[test]
fn smoother_refuses_what_it_has_not() {
    let points = fixture("loop_known.mcap");
    for (arguments, named) in [
        (vec!["--log", &points, "--graph-out", "graph.txt"], "--graph-out"),
        (vec!["--log", &fixture("office_laser.mcap")], "walls need --estimator ekf"),
    ] {
        let (is_success, _, error) = run(&[&arguments[..], &["--estimator", "smoother"]].concat());
        assert!(!is_success && error.contains(named), "{error}");
    }
}

#[test]
fn batch_of_points_is_written_and_walls_have_none() {
    let folder = tempfile::tempdir().unwrap();
    let graph = folder.path().join("graph.txt").display().to_string();
    let (is_success, _, error) = run(&["--log", &fixture("office_laser.mcap"), "--graph-out", &graph]);
    assert!(!is_success && error.contains("no batch"), "{error}");
    let (is_success, _, error) = run(&["--log", &fixture("loop_known.mcap"), "--graph-out", &graph]);
    assert!(is_success, "{error}");
    let text = fs::read_to_string(&graph).unwrap();
    for kind in ["POSE ", "LANDMARK ", "LOG_SCALE ", "MOTION ", "DETECTION "] {
        assert!(text.lines().any(|line| line.starts_with(kind)), "{kind}");
    }
}

#[test]
fn ranges_need_the_smoother_and_no_parameters() {
    let folder = tempfile::tempdir().unwrap();
    let (mut odometry, mut ranges) =
        ("t_s,distance_m,turn_rad\n".to_owned(), "t_s,beacon,range_m\n".to_owned());
    let (mut x, mut y, mut heading) = (0.0_f64, 0.0_f64, 0.0_f64);
    for k in 0..300 {
        let (t, turn) = (0.2 * f64::from(k), 0.05 * (f64::from(k) / 40.0).sin());
        heading += turn;
        x += 0.2 * heading.cos();
        y += 0.2 * heading.sin();
        writeln!(odometry, "{t},0.2,{turn}").unwrap();
        let noise = 0.1 * (7.3 * f64::from(k * k % 97)).sin();
        writeln!(ranges, "{t},4,{}", (12.0 - x).hypot(9.0 - y) + 0.5 + noise).unwrap();
    }
    fs::write(folder.path().join("odometry.csv"), odometry).unwrap();
    fs::write(folder.path().join("ranges.csv"), ranges).unwrap();
    let log = folder.path().display().to_string();

    let (is_success, json, error) = run(&["--log", &log, "--estimator", "smoother", "--json"]);
    assert!(is_success && json.contains("\"n_landmarks\":1"), "{json} {error}");
    assert!(error.contains("noise by the likelihood"), "{error}");
    let (is_success, _, error) = run(&["--log", &log, "--estimator", "smoother", "--save", "map"]);
    assert!(!is_success && error.contains("ranges are one batch"), "{error}");
    let (is_success, _, error) = run(&["--log", &log, "--format", "plaza"]);
    assert!(!is_success && error.contains("--estimator smoother"), "{error}");
    let (is_success, _, error) = run(&["--log", &log, "--estimator", "smoother", "--params", "none.toml"]);
    assert!(!is_success && error.contains("no parameters"), "{error}");
    fs::remove_file(folder.path().join("odometry.csv")).unwrap();
    let (is_success, _, error) = run(&["--log", &log, "--estimator", "smoother"]);
    assert!(!is_success && error.contains("odometry.csv"), "{error}");
}
