use wayfix_color_map::ColorId;
use wayfix_color_model::LocalizationStatus;
use wayfix_estimation_traits::Pose2;

use super::{ClassificationCounts, ColorRun, rate_of};
use crate::system::System;
use wayfix_evaluation::{
    errors::{MeanInterval, PoseWithTruth, trajectory_errors},
    report::{Metric, ReportRun},
};

/// Minimum number of labelled pixels of a colour in an image for a rate of its own.
const MIN_PIXELS: u64 = 20;

/// Figures and events of a run for the report. Names follow the contract of `docs/architecture.md`.
pub fn summarize(run: &mut ColorRun) -> ReportRun {
    let mut metrics = localization(run);
    metrics.extend(classification(run));
    let frames = run.system.frames();
    let mean = |value: &dyn Fn(&super::ColorFrameResult) -> f64| {
        frames.iter().map(value).sum::<f64>() / frames.len().max(1) as f64
    };
    metrics.push(Metric::new("ess_mean", mean(&|frame| frame.effective_particles), ""));
    metrics.push(Metric::new("n_particles_mean", mean(&|frame| frame.n_particles as f64), ""));
    metrics.push(Metric::new("n_frames", frames.len() as f64, ""));
    let longest = frames.iter().map(|frame| frame.step).max().unwrap_or_default();
    let timings = vec![
        Metric::new("frame_mean_ms", mean(&|frame| 1e3 * frame.step.as_secs_f64()), "ms"),
        Metric::new("frame_max_ms", 1e3 * longest.as_secs_f64(), "ms"),
    ];
    ReportRun { metrics, timings, events: run.system.events().counts(), ..ReportRun::default() }
}

fn localization(run: &ColorRun) -> Vec<Metric> {
    let samples: Vec<PoseWithTruth> = run.samples().into_iter().map(|(_, sample)| sample).collect();
    let Some(errors) = trajectory_errors(&samples) else { return Vec::new() };
    let n = samples.len() as f64;
    let positions: Vec<f64> = samples.iter().map(PoseWithTruth::position_error).collect();
    let heading = samples.iter().map(PoseWithTruth::heading_error).sum::<f64>() / n;
    let mut metrics = vec![
        Metric::new("position_mean_m", positions.iter().sum::<f64>() / n, "m"),
        Metric::new("position_error_max_m", positions.iter().copied().fold(0.0, f64::max), "m"),
        Metric::new("heading_mean_deg", heading.to_degrees(), "°"),
        Metric::new("ate_rmse_m", errors.ate_rmse, "m"),
    ];
    metrics.extend(errors.nees_mean.map(|nees| Metric::new("nees_mean", nees, "")));
    metrics.extend(odometry(run));
    let tracked = run.samples().into_iter().filter(|(frame, _)| frame.status == LocalizationStatus::Tracking);
    let is_far = |p: PoseWithTruth| p.position_error() > 0.25 || p.heading_error().to_degrees() > 6.0; // docs/color.md
    let n_false = tracked.filter(|(_, pose)| is_far(*pose)).count();
    metrics.push(Metric::new("n_false_tracking_frames", n_false as f64, ""));
    metrics
}

/// Error of dead reckoning from the same start.
fn odometry(run: &ColorRun) -> Option<Metric> {
    let pairs: Option<Vec<(Pose2<f64>, Pose2<f64>)>> =
        run.samples().into_iter().map(|(frame, sample)| Some((frame.odometry?, sample.truth))).collect();
    let pairs = pairs.filter(|pairs| !pairs.is_empty())?;
    let sum: f64 = pairs.iter().map(|(pose, truth)| (pose.translation - truth.translation).norm()).sum();
    Some(Metric::new("dead_reckoning_position_error_mean_m", sum / pairs.len() as f64, "m"))
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
