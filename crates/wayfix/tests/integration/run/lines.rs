//! `wayfix run lines` from outside.

#![allow(clippy::unwrap_used, reason = "a panic is the verdict of a test, in its helpers too")]

use std::fs;
use std::path::Path;

use assert_cmd::Command;
use serde_json::Value;

fn wayfix(arguments: &[&str]) -> Command {
    let mut command = Command::cargo_bin("wayfix").unwrap();
    command.args(arguments);
    command
}

/// `n` scans of a room of 4 m by 4 m from its middle, whose rear half the laser does not see, then one without an echo.
fn room(path: &Path, n: usize) {
    let range = |beam: usize| {
        let bearing = (beam as f64 - 90.0).to_radians();
        2.0 / bearing.cos().abs().max(bearing.sin().abs())
    };
    // The poses are a mapper's, which moves on while the odometry stands.
    let scan = |seconds: usize, ranges: String| {
        format!("FLASER 181 {ranges}{} 0 0 0 0 0 {seconds} host {seconds}\n", 0.1 * seconds as f64)
    };
    let seen: String = (0..181).map(|beam| format!("{:.6} ", range(beam))).collect();
    let mut text: String = (1..=n).map(|k| scan(k, seen.clone())).collect();
    text += &scan(n + 1, "81.91 ".repeat(181));
    fs::write(path, text).unwrap();
}

#[test]
fn room_shows_three_walls_and_a_blind_scan_is_skipped() {
    let folder = tempfile::tempdir().unwrap();
    let (log, out) = (folder.path().join("room.log"), folder.path().join("out"));
    room(&log, 5);
    let (log, out) = (log.to_str().unwrap(), out.to_str().unwrap());
    let result = wayfix(&["run", "lines", "--log", log, "--json", "--out", out]).assert().success();
    let report: Value = serde_json::from_slice(&result.get_output().stdout).unwrap();
    let metric = |name: &str| report["metrics"][name].as_f64().unwrap_or_else(|| panic!("{report}"));
    assert_eq!((metric("n_scans"), metric("n_skipped"), metric("segments_mean")), (6.0, 1.0, 3.0));
    // The ranges are rounded to a micrometre; half of that is the most that an echo can be off.
    assert!(metric("residual_rms_m") < 0.5e-6, "{report}");
    assert!(metric("scan_mean_us") > 0.0 && metric("scans_per_second") > 0.0);
    let told = String::from_utf8_lossy(&result.get_output().stderr).into_owned();
    assert!(told.contains("none of 181 beams came back"), "{told}");
    for file in ["index.html", "report.json", "estimates.mcap", "figure-1.svg", "figure-4.svg"] {
        assert!(Path::new(out).join(file).is_file(), "{file}");
    }
    let info = wayfix(&["info", log]).assert().success();
    let text = String::from_utf8_lossy(&info.get_output().stdout).into_owned();
    assert!(text.contains("usable for `wayfix run lines`"), "{text}");
}

#[test]
fn a_log_without_scans_is_refused() {
    let folder = tempfile::tempdir().unwrap();
    let log = folder.path().join("walk.txt");
    fs::write(&log, "O 1 0 0\n").unwrap();
    let result = wayfix(&["run", "lines", "--log", log.to_str().unwrap()]).assert().failure();
    let told = String::from_utf8_lossy(&result.get_output().stderr).into_owned();
    assert!(told.contains("walk.txt: no laser scan in the log"), "{told}");
}

#[test]
fn true_walls_in_the_log_are_compared_with() {
    let log = concat!(env!("CARGO_MANIFEST_DIR"), "/../../fixtures/office_laser.mcap");
    let result = wayfix(&["run", "lines", "--log", log, "--json"]).assert().success();
    let report: Value = serde_json::from_slice(&result.get_output().stdout).unwrap();
    let metric = |name: &str| report["metrics"][name].as_f64().unwrap_or_else(|| panic!("{report}"));
    // What each bound comes from stands in fixtures/lines.toml.
    assert!((0.865..=1.0).contains(&metric("extracted_walls_within_2_sigma_share")), "{report}");
    assert!((0.95..=1.0).contains(&metric("found_wall_share")), "{report}");
    assert!(metric("false_wall_share") < 0.1 && metric("nees_mean") > 0.0, "{report}");
}
