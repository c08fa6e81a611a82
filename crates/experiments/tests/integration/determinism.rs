//! The figures are the same bits for any number of threads.

use std::{fs, path::Path};

use crate::common::{Scratch, experiments};

const STORED: &str = concat!(env!("CARGO_MANIFEST_DIR"), "/../../fixtures");

/// The `metrics` of every run in the report, as text.
fn metrics(scratch: &Scratch, threads: &str) -> Vec<String> {
    let out = scratch.path(threads);
    let outcome = experiments([
        "regress",
        "slam",
        "--quick",
        "--threads",
        threads,
        "--fixtures",
        STORED,
        "--out",
        out.to_str().expect("a plain path"),
    ]);
    assert!(outcome.code <= 1, "{}", outcome.stderr); // bounds are the regression's business
    let text = fs::read(out.join(Path::new("report.json"))).expect("report.json");
    let report: serde_json::Value = serde_json::from_slice(&text).expect("JSON");
    let runs = report["suites"][0]["runs"].as_array().expect("runs");
    runs.iter().map(|run| format!("{} {}", run["name"], run["metrics"])).collect()
}

#[test]
fn one_thread_and_two_give_the_same_figures() {
    let scratch = Scratch::new();
    let one = metrics(&scratch, "1");
    assert!(one.len() > 3 && one.iter().all(|run| run.contains("ate_rmse_m")), "{one:?}");
    assert_eq!(one, metrics(&scratch, "2"));
    assert_eq!(one, metrics(&scratch, "5"));
}
