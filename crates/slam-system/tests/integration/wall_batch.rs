//! The batch over the motions, walls and pairings of a run, beside the filter that made them.
#![expect(clippy::unwrap_used, reason = "a panic is the verdict of a test, in its helpers too")]

use std::path::PathBuf;

use wayfix_evaluation::report::ReportRun;
use wayfix_sensor_log::{LogOpenOptions, Record};
use wayfix_slam_system::walls::{WallSlamParams, run, summarize};

fn office() -> Vec<Record> {
    let log = PathBuf::from(env!("CARGO_MANIFEST_DIR")).join("../../fixtures/office_laser.mcap");
    wayfix_sensor_log::open(&log, &LogOpenOptions::default()).unwrap().read_all().0
}

fn figure(summary: &ReportRun, name: &str) -> f64 {
    summary.metrics.iter().find(|metric| metric.name == name).unwrap().value
}

/// Each pose of a batch has all measurements, those of the filter only the earlier ones.
#[test]
fn batch_is_nearer_to_the_truth_than_the_filter() {
    let summary = summarize(&mut run(&office(), &WallSlamParams::default(), |_| {}).unwrap());
    for error in ["ate_rmse_m", "ate_aligned_rmse_m"] {
        let (online, batch) = (figure(&summary, error), figure(&summary, &format!("batch_{error}")));
        assert!(batch > 0.0 && batch < online, "{error} {online}, {batch}");
    }
}

#[test]
fn batch_holds_anchors() {
    let records = office();
    let error = |n_anchors| {
        let params = WallSlamParams { n_anchors, ..WallSlamParams::default() };
        figure(&summarize(&mut run(&records, &params, |_| {}).unwrap()), "batch_ate_rmse_m")
    };
    assert!(error(2) < error(0), "{} {}", error(2), error(0));
}
