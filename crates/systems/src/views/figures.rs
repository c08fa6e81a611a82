use std::collections::BTreeMap;

use wayfix_condensation::{DiscreteStateSpace, LearnedMotion, NavigationOutcome};
use wayfix_evaluation::{
    errors::proportion_interval,
    report::{Metric, ReportRun},
};

use super::{ViewTrial, ViewsRun};

/// Figures and events of a run for the report.
pub fn summarize(run: &ViewsRun) -> ReportRun {
    let trials = &run.trials;
    let count = |is: &dyn Fn(&ViewTrial) -> bool| trials.iter().filter(|trial| is(trial)).count();
    let n = trials.len();
    let successes = count(&ViewTrial::succeeded);
    let (low, high) = proportion_interval(successes as u64, n as u64);
    let certain: Vec<f64> =
        trials.iter().filter_map(|trial| trial.report.steps_to_certainty).map(|steps| steps as f64).collect();
    let n_steps: usize = trials.iter().map(|trial| trial.report.steps).sum();
    let mut metrics = vec![
        Metric::new("trials", n as f64, ""),
        Metric::new("successes", successes as f64, ""),
        Metric::new("success_share_low95", low, ""),
        Metric::new("success_share_high95", high, ""),
        Metric::new("steps_mean", n_steps as f64 / n.max(1) as f64, ""),
    ];
    if !certain.is_empty() {
        let mean = certain.iter().sum::<f64>() / certain.len() as f64;
        metrics.push(Metric::new("steps_to_certainty_mean", mean, ""));
    }
    metrics.extend([
        Metric::new("n_trials_certain_of_place", certain.len() as f64, ""),
        Metric::new("n_places", run.system.views().grid().n_states() as f64, ""),
    ]);
    if let Some(motion) = run.system.motion() {
        metrics.extend(motion_metrics(motion));
    }
    let n_updates: usize = trials.iter().map(|trial| trial.belief_in_truth.len()).sum();
    let timings = vec![
        Metric::new("learning_time_ms", 1e3 * run.learning.as_secs_f64(), "ms"),
        Metric::new("update_time_mean_ms", 1e3 * run.driving.as_secs_f64() / n_updates.max(1) as f64, "ms"),
    ];
    let kidnappings: usize = trials.iter().map(|trial| trial.report.kidnappings).sum();
    let events = [
        ("arrived_at_goal", successes),
        ("arrived_elsewhere", count(&ViewTrial::is_false_arrival)),
        ("arrived_next_to_goal", count(&|trial| trial.is_false_arrival() && is_beside(run, trial))),
        ("ended_unsure_of_place", count(&|trial| trial.report.arrival == NavigationOutcome::Unsure)),
        ("kidnapping_detected", kidnappings),
    ];
    let events: BTreeMap<String, u64> =
        events.into_iter().map(|(name, n)| (name.to_owned(), n as u64)).collect();
    ReportRun {
        metrics,
        timings,
        events,
        notes: failures(trials).into_iter().collect(),
        ..ReportRun::default()
    }
}

/// What was learned from logged moves.
pub(super) fn motion_metrics(motion: &LearnedMotion) -> [Metric; 3] {
    let [columns, rows] = motion.diffusion_sigmas();
    [
        Metric::new("n_logged_moves", motion.n_moves() as f64, ""),
        Metric::new("diffusion_sigma_columns", columns, "places"),
        Metric::new("diffusion_sigma_rows", rows, "places"),
    ]
}

/// Whether a trial ended in one of the eight places around its goal.
fn is_beside(run: &ViewsRun, trial: &ViewTrial) -> bool {
    let grid = run.system.views().grid();
    let ((x, y), (goal_x, goal_y)) = (grid.place(trial.end), grid.place(trial.goal));
    x.abs_diff(goal_x).max(y.abs_diff(goal_y)) == 1
}

/// The failed trials, for inspection.
fn failures(trials: &[ViewTrial]) -> Option<String> {
    const LISTED: usize = 5;
    let failed: Vec<String> = (0_u32..)
        .zip(trials)
        .filter(|(_, trial)| !trial.succeeded())
        .map(|(index, trial)| format!("{index} ({} → {}, ended at {})", trial.start, trial.goal, trial.end))
        .collect();
    let more = failed.len().saturating_sub(LISTED);
    let listed = failed[..failed.len() - more].join(", ");
    match (failed.is_empty(), more) {
        (true, _) => None,
        (false, 0) => Some(format!("Trials that failed: {listed}.")),
        (false, more) => Some(format!("Trials that failed: {listed} and {more} more.")),
    }
}
