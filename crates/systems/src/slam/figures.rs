use wayfix_estimation_traits::{LieGroup, Pose2};
use wayfix_slam_ekf::observability::ObservabilityRecorder;

use super::{SlamRun, StampedEstimate};
use wayfix_evaluation::{
    errors::{Sample, align, landmark_errors, median_distance, rms_distance, trajectory_errors},
    report::{Metric, Run},
};

/// The figures and events of a run, ready for the report.
pub fn summarize(run: &mut SlamRun) -> Run {
    let (metrics, timings) = metrics(run);
    let mut summary = Run { metrics, timings, events: run.events().counts(), ..Run::default() };
    unobservable_directions(run.system.observability(), &mut summary);
    summary
}

/// Adds which motions of the whole map nothing has ever constrained, where that was recorded.
pub(crate) fn unobservable_directions(recorder: Option<&ObservabilityRecorder>, summary: &mut Run) {
    let Some(recorder) = recorder else { return };
    let free = recorder.unobservable_directions();
    summary.metrics.push(Metric::new("state_dimension", recorder.dimension() as f64, ""));
    summary.metrics.push(Metric::new("n_free_directions", free.len() as f64, ""));
    summary.notes.push(match free.as_slice() {
        [] => "Everything about the map is tied to the world.".to_owned(),
        free => {
            let names: Vec<String> = free.iter().map(ToString::to_string).collect();
            format!("Nothing has ever constrained: {}.", names.join("; "))
        }
    });
}

/// Figures that the log decides, then those that change from call to call. Names as in the contract of `docs/architecture.md`.
fn metrics(run: &mut SlamRun) -> (Vec<Metric>, Vec<Metric>) {
    let samples: Vec<Sample> = run.samples().into_iter().map(|(_, sample)| sample).collect();
    let mut metrics = Vec::new();
    if let Some(errors) = trajectory_errors(&samples) {
        metrics.push(Metric::new("ate_rmse_m", errors.ate_rmse, "m"));
        metrics.push(Metric::new("ate_aligned_rmse_m", errors.ate_aligned_rmse, "m"));
        metrics.push(Metric::new("heading_rmse_deg", errors.heading_rmse.to_degrees(), "°"));
        metrics.extend(errors.nees_mean.map(|nees| Metric::new("nees_mean", nees, "")));
    }
    let dead_reckoning: Vec<Sample> = run
        .samples()
        .into_iter()
        .map(|(stamped_estimate, sample)| Sample { estimate: stamped_estimate.dead_reckoning, ..sample })
        .collect();
    if let Some(errors) = trajectory_errors(&dead_reckoning) {
        metrics.push(Metric::new("dead_reckoning_aligned_rmse_m", errors.ate_aligned_rmse, "m"));
    }
    metrics.extend(position_metrics(run));
    let of_path = align(samples.iter().map(|sample| (sample.estimate.translation, sample.truth.translation)));
    if let Some((rmse, aligned)) =
        landmark_errors(&run.landmarks(), &run.true_landmarks, run.correspondence(), &of_path)
    {
        metrics.push(Metric::new("landmark_rmse_m", rmse, "m"));
        metrics.push(Metric::new("landmark_aligned_rmse_m", aligned, "m"));
    }
    let events = run.events();
    let n_rejected =
        ["gated", "duplicate", "unusable", "record_refused"].map(|name| events.get(name)).iter().sum::<u64>();
    metrics.push(Metric::new("n_landmarks", run.system.filter().n_landmarks() as f64, ""));
    metrics.push(Metric::new("n_rejected", n_rejected as f64, ""));
    (metrics, timings(run.system.stamped_estimates()))
}

/// Where the log has true positions of an antenna and no true poses.
fn position_metrics(run: &SlamRun) -> Vec<Metric> {
    let positions = run.positions();
    if !run.samples().is_empty() || positions.is_empty() {
        return Vec::new();
    }
    let estimated = positions.iter().map(|(_, estimate, truth)| (*estimate, *truth));
    let reckoned = positions
        .iter()
        .map(|(stamped_estimate, _, truth)| (run.system.antenna(&stamped_estimate.dead_reckoning), *truth));
    let motion = align(estimated.clone());
    let mut metrics = Vec::new();
    let mut add = |name, value: Option<f64>| metrics.extend(value.map(|value| Metric::new(name, value, "m")));
    add("ate_rmse_m", rms_distance(estimated.clone(), &Pose2::identity()));
    add("ate_median_m", median_distance(estimated.clone(), &Pose2::identity()));
    add("ate_aligned_rmse_m", rms_distance(estimated.clone(), &motion));
    add("ate_aligned_median_m", median_distance(estimated, &motion));
    add("dead_reckoning_aligned_rmse_m", rms_distance(reckoned.clone(), &align(reckoned)));
    metrics
}

/// Mean, median and largest computing time of a step.
pub(crate) fn timings(stamped_estimates: &[StampedEstimate]) -> Vec<Metric> {
    let mut steps: Vec<f64> =
        stamped_estimates.iter().map(|stamped_estimate| stamped_estimate.step.as_secs_f64() * 1e6).collect();
    steps.sort_unstable_by(f64::total_cmp);
    let mean = steps.iter().sum::<f64>() / steps.len() as f64;
    let of_rank = |rank: usize| steps.get(rank).copied().unwrap_or(f64::NAN);
    vec![
        Metric::new("step_mean_us", mean, "µs"),
        Metric::new("step_median_us", of_rank(steps.len() / 2), "µs"),
        Metric::new("step_max_us", of_rank(steps.len().saturating_sub(1)), "µs"),
    ]
}
