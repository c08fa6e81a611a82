//! What others may build on: names of figures, their absence without truth, and settings that follow a log through conversion.

use std::{fs, path::Path};

use wayfix_sensor_log::{LogFormat, LogOpenOptions, Record, open, write};

use crate::common::{Scratch, run_slam, utias_walk, walk, walk_without_truth, wayfix};

const ALWAYS: [&str; 5] = ["n_landmarks", "n_rejected", "step_mean_us", "step_median_us", "step_max_us"];
const WITH_TRUTH: [&str; 6] = [
    "ate_rmse_m",
    "ate_aligned_rmse_m",
    "heading_rmse_deg",
    "landmark_rmse_m",
    "landmark_aligned_rmse_m",
    "nees_mean",
];

#[test]
fn metric_names_follow_the_contract_and_truth_is_needed() {
    let scratch = Scratch::new();
    let with = run_slam(&scratch.file("with.txt", walk(40)), &["--seed", "7"]).json();
    let without = run_slam(&scratch.file("without.txt", walk_without_truth(40)), &[]).json();
    let names = |object: &serde_json::Value| -> Vec<String> {
        object["metrics"].as_object().expect("an object").keys().cloned().collect()
    };
    for name in ALWAYS {
        assert!(with["metrics"][name].is_number() && without["metrics"][name].is_number(), "{name}");
    }
    for name in WITH_TRUTH {
        assert!(with["metrics"][name].is_number(), "{name} in {with}");
    }
    let mut left: Vec<String> = ALWAYS.map(str::to_owned).to_vec();
    left.sort();
    assert_eq!(names(&without), left);
    assert_eq!(with["seed"], 7);
    assert!(with["events"].as_object().expect("an object").values().all(serde_json::Value::is_u64));
}

#[test]
fn a_walk_without_noise_is_followed_without_error() {
    let scratch = Scratch::new();
    let outcome = run_slam(&scratch.file("walk.txt", walk(100)), &[]);
    // Nothing errs but rounding: 1e-6 m leaves room for a hundred linear solves and no room for a wrong model.
    for name in ["ate_rmse_m", "landmark_rmse_m"] {
        assert!(outcome.metric(name) < 1e-6, "{name}: {}", outcome.metric(name));
    }
    assert_eq!(outcome.metric("n_landmarks"), 8.0);
}

#[test]
fn a_log_in_several_files_gives_the_figures_of_the_whole() {
    let scratch = Scratch::new();
    let log = open(scratch.file("walk.txt", walk(60)), &LogOpenOptions::default()).expect("opens");
    let records: Vec<Record> = log.collect();
    let (first, second) = records.split_at(records.len() / 2);
    let part = |name: &str, records: &[Record]| {
        let path = scratch.path(name);
        write(&path, LogFormat::Mcap, records.to_vec()).expect("writes");
        path
    };
    let [whole, first, second] = [("whole.mcap", &records[..]), ("a.mcap", first), ("b.mcap", second)]
        .map(|(name, part_of)| part(name, part_of));
    let outcome = run_slam(&second, &["--log", first.to_str().expect("a plain path")]);
    assert_eq!(outcome.figures(), run_slam(&whole, &[]).figures());
    let alone =
        run_slam(&second, &["--log", scratch.file("other.txt", walk(3)).to_str().expect("a plain path")]);
    assert_eq!(alone.code, 1);
    assert!(alone.stderr.contains("only MCAP files can be parts"), "{}", alone.stderr);
}

#[test]
fn out_holds_the_page_the_report_the_pictures_and_the_estimates() {
    let scratch = Scratch::new();
    let (log, out) = (scratch.file("walk.txt", walk(40)), scratch.path("new/results"));
    let outcome = run_slam(&log, &["--out", out.to_str().expect("a plain path")]);
    let report: serde_json::Value =
        serde_json::from_slice(&fs::read(out.join("report.json")).expect("report.json")).expect("JSON");
    let metrics = report["suites"][0]["runs"][0]["metrics"].as_array().expect("metrics");
    let reported = metrics.iter().find(|metric| metric["name"] == "ate_rmse_m").expect("ate_rmse_m");
    assert_eq!(reported["value"].as_f64(), Some(outcome.metric("ate_rmse_m")));
    let page = fs::read_to_string(out.join("index.html")).expect("index.html");
    let drawn = page.replace("isNaN", ""); // a word of the script
    assert!(drawn.contains("<svg") && !drawn.contains("NaN"));
    assert!(fs::read_to_string(out.join("figure-1.svg")).expect("a picture").contains("<svg"));
    // What was estimated lies beside the records of the log, so it runs again, as the robot it was.
    let again = run_slam(&out.join("estimates.mcap"), &[]);
    assert_eq!(again.figures(), outcome.figures());
}

#[test]
fn a_converted_log_keeps_the_settings_of_its_robot() {
    let scratch = Scratch::new();
    let (folder, mcap) = (utias_walk(&scratch, "set", 3, 300), scratch.path("robot3.mcap"));
    let converted = wayfix([Path::new("convert"), &folder, &mcap]);
    assert_eq!(converted.code, 0, "{}", converted.stderr);
    let (before, after) = (run_slam(&folder, &[]), run_slam(&mcap, &[]));
    assert_eq!(after.figures(), before.figures());
    assert_eq!(after.json()["events"], before.json()["events"]);
    let generic = run_slam(&mcap, &["--profile", "generic"]);
    assert_ne!(generic.figures(), before.figures(), "the settings matter on this log");
    assert!(wayfix([Path::new("info"), &mcap]).stdout.contains("mcap converted from utias"));
}

#[test]
fn printed_parameters_given_back_change_nothing() {
    let scratch = Scratch::new();
    let folder = utias_walk(&scratch, "set", 3, 200);
    let printed = run_slam(&folder, &["--print-params"]);
    assert_eq!(printed.code, 0);
    let file = scratch.file("params.toml", &printed.stdout);
    let back = run_slam(&folder, &["--profile", "generic", "--params", file.to_str().expect("a plain path")]);
    assert_eq!(back.figures(), run_slam(&folder, &[]).figures());
}

#[test]
fn a_log_that_tells_of_its_motion_twice_moves_once() {
    let scratch = Scratch::new();
    let folder = utias_walk(&scratch, "set", 3, 100);
    let once = run_slam(&folder, &[]);
    let (mut records, _) = wayfix_sensor_log::open(&folder, &wayfix_sensor_log::LogOpenOptions::default())
        .expect("a UTIAS set")
        .read_all();
    let increment = wayfix_sensor_log::RecordData::OdometryIncrement(wayfix_estimation_traits::Pose2::new(
        0.2, 0.01, 0.1,
    ));
    let last = records.last().expect("records").stamp;
    let twice = (1..50).map(|k| wayfix_sensor_log::Record {
        stamp: wayfix_sensor_log::Stamp::from_nanoseconds(last.nanoseconds() - k * 100_000_000),
        data: increment.clone(),
    });
    records.extend(twice);
    records.sort_by_key(|record| record.stamp);
    let path = scratch.path("twice.mcap");
    wayfix_sensor_log::write(&path, wayfix_sensor_log::LogFormat::Mcap, records).expect("writable");
    let outcome = run_slam(&path, &["--profile", "utias"]);
    assert_eq!(outcome.event("second_odometry_source_ignored"), 49);
    assert_eq!(outcome.metric("ate_rmse_m"), once.metric("ate_rmse_m"));
}

#[test]
fn help_teaches_the_options_and_shows_examples() {
    for (arguments, taught) in [
        (vec!["--help"], "wayfix info slam_100.txt"),
        (vec!["run", "slam", "--help"], "ate_aligned_rmse_m"),
        (vec!["run", "slam", "--help"], "range_sigma = 0.10"),
        (vec!["convert", "--help"], "MCAP stores everything"),
        (vec!["info", "--help"], "UTIAS"),
    ] {
        let outcome = wayfix(&arguments);
        assert_eq!(outcome.code, 0);
        assert!(outcome.stdout.contains(taught), "{arguments:?}: {}", outcome.stdout);
    }
}
