//! A regression that several machines share gives the report of one machine.

use std::{fs, path::Path};

use serde_json::Value;

use crate::common::{Outcome, Scratch, experiments};

const STORED: &str = concat!(env!("CARGO_MANIFEST_DIR"), "/../../fixtures");

fn call(command: &str, more: &[&str], out: &Path) -> Outcome {
    let fixed = [command, "--fixtures", STORED, "--out", out.to_str().expect("a plain path")];
    experiments(fixed.iter().chain(more))
}

/// The report without what no two calls share: times, and the machine.
fn report(out: &Path) -> Value {
    let mut report: Value =
        serde_json::from_slice(&fs::read(out.join("report.json")).expect("report.json")).expect("JSON");
    report["machine"] = Value::Null;
    for suite in report["suites"].as_array_mut().expect("suites") {
        for run in suite["runs"].as_array_mut().expect("runs") {
            run["seconds"] = Value::Null;
            run["timings"] = Value::Null;
            let Some(figures) = run["figures"].as_array_mut() else { continue };
            let is_time =
                |figure: &Value| figure["alt"].as_str().is_some_and(|alt| alt.starts_with("Computing time"));
            figures.iter_mut().filter(|figure| is_time(figure)).for_each(|figure| *figure = Value::Null);
        }
    }
    report
}

fn n_pictures(out: &Path) -> usize {
    fs::read_to_string(out.join("index.html")).expect("index.html").matches("<svg ").count()
}

#[test]
fn three_shares_merge_into_the_report_of_one_machine() {
    let scratch = Scratch::new();
    let campaign = ["lines/simplification", "slam/loop_known", "slam/rough_known", "--quick", "--seeds", "2"];
    let whole = scratch.path("whole");
    let code = call("regress", &campaign, &whole).code;
    assert!(code <= 1); // bounds are the regression's business

    let shares = ["1/3", "2/3", "3/3"].map(|shard| {
        let out = scratch.path(&shard.replace('/', "-of-"));
        let outcome = call("regress", &[&campaign[..], &["--shard", shard]].concat(), &out);
        assert_eq!(outcome.code, 0, "{}", outcome.stderr);
        out.to_str().expect("a plain path").to_owned()
    });
    let merged = scratch.path("merged");
    let outcome = call("merge-reports", &[&shares[2], &shares[0], &shares[1]], &merged);
    assert_eq!(outcome.code, code, "{}", outcome.stderr);
    assert_eq!(report(&merged), report(&whole));
    assert_eq!(n_pictures(&merged), n_pictures(&whole));
    assert!(report(&whole).to_string().contains(r#""spread":{"half_width":"#));
    let runs = report(&whole)["suites"][1]["runs"].clone();
    let logs: Vec<&str> =
        runs.as_array().expect("runs").iter().filter_map(|run| run["log"].as_str()).collect();
    assert!(!logs.is_empty(), "{runs}");
    for log in logs {
        assert_eq!(
            fs::read(merged.join(log)).expect("copied"),
            fs::read(whole.join(log)).expect("written"),
            "{log}"
        );
    }

    let missing = call("merge-reports", &[&shares[0], &shares[1]], &merged);
    assert_eq!(missing.code, 1);
    assert!(missing.stderr.contains("runs are missing, the first is"), "{}", missing.stderr);
    let doubled = call("merge-reports", &[&shares[0], &shares[1], &shares[2], &shares[0]], &merged);
    assert!(doubled.stderr.contains("was done twice"), "{}", doubled.stderr);
    let other = scratch.path("other");
    call("regress", &["lines/simplification", "--quick", "--shard", "1/2"], &other);
    let mixed = call("merge-reports", &[&shares[0], other.to_str().expect("a plain path")], &merged);
    assert!(mixed.stderr.contains("of another campaign"), "{}", mixed.stderr);
    let nothing = call("merge-reports", &[scratch.path("nowhere").to_str().expect("a plain path")], &merged);
    assert!(nothing.stderr.contains("wayfix-experiments regress --shard"), "{}", nothing.stderr);
    fs::write(other.join("part.json"), "{\"campaign\":{}}").expect("written");
    let broken = call("merge-reports", &[other.to_str().expect("a plain path")], &merged);
    assert!(broken.code == 1 && broken.stderr.contains("not usable"), "{}", broken.stderr);
}
