use std::time::Duration;

use wayfix_evaluation::{
    errors::{PoseWithTruth, relative_errors},
    report::{Metric, ReportRun},
};
use wayfix_system_core::System;

use super::{CmlRun, CmlTask, CmlViewResult};

/// Figures and events of a run for the report.
pub fn summarize(run: &mut CmlRun) -> ReportRun {
    let mut metrics = errors(run);
    let frames = run.system.frames();
    let n = frames.len() as f64;
    let sample = run.system.sample();
    let certain = frames.iter().filter(|frame| frame.is_certain).count() as f64;
    metrics.push(Metric::new("n_references", run.system.localizer().map().len() as f64, ""));
    metrics.push(Metric::new("n_localized_views", sample.n_seen() as f64, ""));
    metrics.push(Metric::new("unimodal_share", certain / n.max(1.0), ""));
    let micros = |step: Duration| 1e6 * step.as_secs_f64();
    let timings = vec![
        Metric::new(
            "step_mean_us",
            frames.iter().map(|frame| micros(frame.step)).sum::<f64>() / n.max(1.0),
            "µs",
        ),
        Metric::new("step_max_us", micros(run.system.longest_step()), "µs"),
    ];
    let mut notes = vec![task(run.task).to_owned()];
    notes.extend(run.notes.iter().cloned());
    notes.extend(sample.note("figures and pictures"));
    ReportRun { metrics, timings, events: run.system.events().counts(), notes, ..ReportRun::default() }
}

/// Description of the task in one sentence.
pub fn task(task: CmlTask) -> &'static str {
    match task {
        CmlTask::ConcurrentMapBuilding => {
            "concurrent map building and localization: the map grew from nothing, the start was known"
        }
        CmlTask::LearnThenLocalize => "learn, then localize: the map was taught with known poses first",
        CmlTask::LocalizeInSavedMap => "localization in a saved map",
    }
}

fn errors(run: &CmlRun) -> Vec<Metric> {
    let samples = run.samples();
    let errors = sorted(samples.iter().map(|(_, sample)| sample.position_error()));
    let Some(last) = errors.len().checked_sub(1) else { return Vec::new() };
    let n = errors.len() as f64;
    let mut metrics = vec![
        Metric::new("error_mean_m", errors.iter().sum::<f64>() / n, "m"),
        Metric::new("error_median_m", errors[last / 2], "m"),
        Metric::new("error_max_m", errors[last], "m"),
    ];
    if run.headings_are_measured {
        let heading = samples.iter().map(|(_, sample)| sample.heading_error()).sum::<f64>() / n;
        metrics.push(Metric::new("heading_mean_deg", heading.to_degrees(), "°"));
        let samples: Vec<PoseWithTruth> = samples.iter().map(|(_, sample)| *sample).collect();
        metrics.extend(relative_errors(&samples).metrics());
    }
    metrics.extend(mean(
        samples.iter().filter_map(|(frame, sample)| {
            Some((frame.odometry?.translation - sample.truth.translation).norm())
        }),
        "dead_reckoning_error_mean_m",
    ));
    if run.task != CmlTask::ConcurrentMapBuilding {
        metrics.extend(mean(samples.iter().filter_map(nearest_error), "nearest_reference_error_mean_m"));
    }
    metrics
}

/// Distance from the true position to the reference nearest in appearance, m: no filter, no odometry.
fn nearest_error((frame, sample): &(&CmlViewResult, PoseWithTruth)) -> Option<f64> {
    let (_, [x, y]) = frame.nearest?;
    Some((x - sample.truth.x()).hypot(y - sample.truth.y()))
}

fn mean(values: impl Iterator<Item = f64>, name: &str) -> Option<Metric> {
    let values: Vec<f64> = values.collect();
    let mean = values.iter().sum::<f64>() / values.len() as f64;
    (!values.is_empty()).then(|| Metric::new(name, mean, "m"))
}

fn sorted(values: impl Iterator<Item = f64>) -> Vec<f64> {
    let mut values: Vec<f64> = values.collect();
    values.sort_by(f64::total_cmp);
    values
}
