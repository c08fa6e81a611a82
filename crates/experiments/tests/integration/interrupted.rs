//! A regression that fails in part or is interrupted keeps what it finished, and goes on.

use std::fs;

use serde_json::Value;

use crate::common::{Scratch, experiments};

const PLAN: &str = r#"
[[run]]
name = "broken"
log = "absent.mcap"

[[run]]
name = "whole"
n_polylines = 3
"#;

fn runs(report: &[u8]) -> Vec<Value> {
    let report: Value = serde_json::from_slice(report).expect("JSON");
    report["suites"][0]["runs"].as_array().expect("runs").clone()
}

#[test]
fn a_failing_run_leaves_the_others_and_resume_repeats_it() {
    let scratch = Scratch::new();
    let plan = scratch.file("lines.toml", PLAN);
    let (fixtures, out) = (plan.parent().expect("a folder"), scratch.path("out"));
    let call = |more: &[&str]| {
        let [fixtures, out] = [fixtures, &out].map(|path| path.to_str().expect("a plain path"));
        experiments([&["regress", "lines", "--fixtures", fixtures, "--out", out], more].concat())
    };
    let report = || runs(&fs::read(out.join("report.json")).expect("report.json"));

    let first = call(&[]);
    assert_eq!(first.code, 1, "{}", first.stderr);
    assert!(first.stdout.starts_with("2 runs, "), "{}", first.stdout);
    for line in ["✗ lines / broken", "lines / whole"] {
        assert!(first.stdout.contains(line), "{}", first.stdout);
    }
    let [broken, whole] = &report()[..] else { unreachable!("two runs") };
    assert!(broken["error"].as_str().is_some_and(|error| error.contains("absent.mcap")), "{broken}");
    assert!(whole["error"].is_null() && out.join("index.html").is_file());

    let second = call(&["--resume"]);
    assert!(second.stdout.starts_with("1 run, ") && second.code == 1, "{}", second.stdout);
    assert_eq!(report()[1]["seconds"], whole["seconds"], "it was not repeated");
    let other = call(&["--resume", "--seed", "2"]);
    assert!(other.code == 1 && other.stderr.contains("another campaign"), "{}", other.stderr);
}

#[test]
fn an_unknown_run_is_an_error_with_the_nearest_name() {
    let fixtures = concat!(env!("CARGO_MANIFEST_DIR"), "/../../fixtures");
    let outcome = experiments(["regress", "loop_know", "--fixtures", fixtures]);
    assert_eq!(outcome.code, 1);
    assert!(outcome.stderr.contains("did you mean"), "{}", outcome.stderr);
}
