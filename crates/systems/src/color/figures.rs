use wayfix_color_map::ColorId;
use wayfix_evaluation::{
    errors::{MeanInterval, PoseWithTruth, relative_errors},
    report::{Metric, ReportRun},
};
use wayfix_system_core::System;

use super::{ClassificationCounts, ColorRun, rate_of};

/// Minimum number of labelled pixels of a colour in an image for a rate of its own.
const MIN_PIXELS: u64 = 20;

/// Figures and events of a run for the report.
pub fn summarize(run: &mut ColorRun) -> ReportRun {
    let mut metrics = run.totals.errors();
    let samples: Vec<PoseWithTruth> = run.samples().into_iter().map(|(_, sample)| sample).collect();
    metrics.extend(relative_errors(&samples).metrics());
    metrics.extend(classification(run));
    metrics.extend(run.totals.particles());
    let notes = run
        .system
        .sample()
        .note("classification rates, relative pose errors and pictures")
        .into_iter()
        .collect();
    let (timings, events) = (run.totals.timings(), run.system.events().counts());
    ReportRun { metrics, timings, events, notes, ..ReportRun::default() }
}

fn classification(run: &ColorRun) -> Vec<Metric> {
    let labelled: Vec<&ClassificationCounts> =
        run.system.frames().iter().filter_map(|frame| frame.labelled.as_ref()).collect();
    let overall: Vec<f64> = labelled.iter().filter_map(|counts| counts.rate()).collect();
    let Some(overall) = MeanInterval::of(&overall) else { return Vec::new() };
    let mut metrics = Metric::of_mean("classification_rate", &overall, "").to_vec();
    metrics.push(Metric::new("n_labelled_images", overall.n as f64, ""));
    for (at, name) in run.system.map().colors().iter().enumerate() {
        let rates = rate_of(labelled.iter().copied(), ColorId(at as u8), MIN_PIXELS);
        if let Some(rate) = MeanInterval::of(&rates) {
            metrics.extend(Metric::of_mean(&format!("classification_rate_{name}"), &rate, ""));
        }
    }
    metrics
}
