use std::time::Duration;

use nalgebra::DefaultAllocator;
use wayfix_evaluation::{
    errors::{PoseWithTruth, TrajectoryErrors, relative_errors, trajectory_errors},
    report::{Metric, ReportRun},
};
use wayfix_slam_ekf::{
    LandmarkDim, MeasurementDim, RobotDim, SlamAlloc, observability::ObservabilityRecorder,
};

use super::{FrontEnd, SlamRun, StampedEstimate};

/// Events that count a refused observation or record.
const REJECTIONS: [&str; 5] = [
    "observation_rejected_by_gate",
    "observation_duplicate",
    "observation_unusable",
    "measurement_gated",
    "record_refused",
];

/// The figures and events of a run, ready for the report; `of_map` are the figures of the kind of landmark.
pub(crate) fn summary<F: FrontEnd, T>(run: &mut SlamRun<F, T>, of_map: Vec<Metric>) -> ReportRun
where
    DefaultAllocator: SlamAlloc<RobotDim<F::Model>, LandmarkDim<F::Model>, MeasurementDim<F::Model>>,
{
    let mut metrics = path_metrics(&run.samples(), run.truth.is_estimate());
    let reference = trajectory_errors(&run.batch_samples());
    metrics.extend(of_map);
    let n_landmarks = run.system.filter().n_landmarks();
    let events = run.events();
    let has_failed = events.get("smoother_failed") > 0;
    let n_rejected = REJECTIONS.map(|name| events.get(name)).iter().sum::<u64>();
    metrics.push(Metric::new("n_landmarks", n_landmarks as f64, ""));
    metrics.push(Metric::new("n_rejected", n_rejected as f64, ""));
    let timings = timings(run.system.stamped_estimates(), run.system.estimator.longest_step);
    let mut summary = ReportRun { metrics, timings, events: run.events().counts(), ..ReportRun::default() };
    summary.notes.extend(run.system.estimator.stamped_estimates.note("figures and pictures"));
    unobservable_directions(run.system.observability(), &mut summary);
    if !summary.metrics.iter().any(|metric| metric.name == "ate_aligned_rmse_m") {
        summary.notes.push("No true poses: no figures of accuracy (--truth FILE gives some).".to_owned());
    }
    if let Some(batch) = reference {
        compare_with_batch(&batch, &mut summary);
    }
    let has = |name: &str| summary.metrics.iter().any(|metric| metric.name == name);
    if has("ate_aligned_rmse_m") && !has("batch_ate_aligned_rmse_m") && !has_failed {
        let is_smoothed = run.smoothed.as_ref().is_some_and(|smoothed| !smoothed.is_batch);
        let why = if is_smoothed {
            "the smoother's estimates are the result"
        } else {
            "`wayfix run slam` makes one of points or walls, if it begins without a map"
        };
        summary.notes.push(format!("No batch to compare with: {why}."));
    }
    summary
}

/// Adds the errors of the optimum of the same measurements and pairings.
fn compare_with_batch(batch: &TrajectoryErrors, summary: &mut ReportRun) {
    summary.metrics.push(Metric::new("batch_ate_rmse_m", batch.ate_rmse, "m"));
    summary.metrics.push(Metric::new("batch_ate_aligned_rmse_m", batch.ate_aligned_rmse, "m"));
    let online = summary.metrics.iter().find(|metric| metric.name == "ate_aligned_rmse_m");
    let note = online.map(|online| {
        let (online, batch) = (online.value, batch.ate_aligned_rmse);
        format!("Aligned path error: online {online:.3} m, batch {batch:.3} m (least squares on the same measurements and pairings).")
    });
    summary.notes.extend(note);
}

/// Errors of the path and of odometry alone.
pub(crate) fn path_metrics(
    samples: &[(StampedEstimate, PoseWithTruth)],
    truth_is_estimate: bool,
) -> Vec<Metric> {
    let errors_of = |samples: Vec<PoseWithTruth>| trajectory_errors(&samples);
    let mut metrics = Vec::new();
    let of_filter: Vec<PoseWithTruth> = samples.iter().map(|(_, sample)| *sample).collect();
    let relative = relative_errors(&of_filter);
    if let Some(errors) = errors_of(of_filter) {
        metrics.push(Metric::new("ate_rmse_m", errors.ate_rmse, "m"));
        metrics.push(Metric::new("ate_aligned_rmse_m", errors.ate_aligned_rmse, "m"));
        metrics.push(Metric::new("heading_rmse_deg", errors.heading_rmse.to_degrees(), "°"));
        metrics.extend(relative.metrics());
        let nees = errors.nees_mean.filter(|_| !truth_is_estimate);
        metrics.extend(nees.map(|nees| Metric::new("nees_mean", nees, "")));
    }
    let reckoned = |(at, sample): &(StampedEstimate, PoseWithTruth)| PoseWithTruth {
        estimate: at.dead_reckoning,
        ..*sample
    };
    if let Some(errors) = errors_of(samples.iter().map(reckoned).collect()) {
        metrics.push(Metric::new("dead_reckoning_aligned_rmse_m", errors.ate_aligned_rmse, "m"));
    }
    metrics
}

/// Adds which motions of the whole map nothing has ever constrained, where that was recorded.
fn unobservable_directions(recorder: Option<&ObservabilityRecorder>, summary: &mut ReportRun) {
    let Some(recorder) = recorder else { return };
    let free = recorder.unobservable_directions();
    summary.metrics.push(Metric::new("state_dimension", recorder.dimension() as f64, ""));
    summary.metrics.push(Metric::new("n_unobservable_directions", free.len() as f64, ""));
    summary.notes.push(match free.as_slice() {
        [] => "All directions of the map are constrained.".to_owned(),
        free => {
            let names: Vec<String> = free.iter().map(ToString::to_string).collect();
            format!("Never constrained: {}.", names.join("; "))
        }
    });
}

/// Mean, median and largest computing time of a step.
pub(crate) fn timings(stamped_estimates: &[StampedEstimate], longest: Duration) -> Vec<Metric> {
    let mut steps: Vec<f64> =
        stamped_estimates.iter().map(|stamped_estimate| stamped_estimate.step.as_secs_f64() * 1e6).collect();
    steps.sort_unstable_by(f64::total_cmp);
    let mean = steps.iter().sum::<f64>() / steps.len() as f64;
    vec![
        Metric::new("step_mean_us", mean, "µs"),
        Metric::new("step_median_us", steps.get(steps.len() / 2).copied().unwrap_or(f64::NAN), "µs"),
        Metric::new("step_max_us", longest.as_secs_f64() * 1e6, "µs"),
    ]
}
