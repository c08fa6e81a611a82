use wayfix_condensation::ActionSelection;
use wayfix_evaluation::{errors::MeanInterval, report::Metric};

use super::{ViewTrial, ViewsRun};

/// Compares greedy and informed choice of actions on the same drives, with equal starts and goals.
///
/// A drive that never became certain counts with all its moves, so neither choice gains by excluding drives. Differences are greedy minus
/// informed, with the paired 95 % interval: above 0 the informed choice saves moves.
pub fn compare_choices(greedy: &ViewsRun, informed: &ViewsRun) -> Vec<Metric> {
    let certain = |trial: &ViewTrial| trial.report.steps_to_certainty.unwrap_or(trial.report.steps) as f64;
    let all = |trial: &ViewTrial| trial.report.steps as f64;
    let mut metrics =
        vec![Metric::new("n_paired_drives", greedy.trials.len().min(informed.trials.len()) as f64, "")];
    for (name, run) in [("greedy", greedy), ("informed", informed)] {
        let successes = run.trials.iter().filter(|trial| trial.succeeded()).count();
        let n_certain = run.trials.iter().filter(|trial| trial.report.steps_to_certainty.is_some()).count();
        metrics.push(Metric::new(format!("{name}_successes"), successes as f64, ""));
        metrics.push(Metric::new(format!("{name}_n_trials_certain_of_place"), n_certain as f64, ""));
    }
    metrics.extend(saved("steps_to_certainty", greedy, informed, certain));
    metrics.extend(saved("steps", greedy, informed, all));
    metrics
}

/// The choice compared with the greedy one.
pub const INFORMED: ActionSelection = ActionSelection::Informed { hypotheses: 16 };

fn saved(
    name: &str,
    greedy: &ViewsRun,
    informed: &ViewsRun,
    figure: impl Fn(&ViewTrial) -> f64,
) -> Vec<Metric> {
    let figures = |run: &ViewsRun| run.trials.iter().map(&figure).collect::<Vec<f64>>();
    let (greedy, informed) = (figures(greedy), figures(informed));
    let mean = |values: &[f64]| values.iter().sum::<f64>() / values.len() as f64;
    let differences: Vec<f64> =
        greedy.iter().zip(&informed).map(|(greedy, informed)| greedy - informed).collect();
    let (middle, half) = MeanInterval::of(&differences)
        .map_or((f64::NAN, f64::NAN), |interval| (interval.mean, interval.half_width));
    let figures = [
        (format!("greedy_{name}_mean"), mean(&greedy)),
        (format!("informed_{name}_mean"), mean(&informed)),
        (format!("{name}_saved_by_informed_mean"), middle),
        (format!("{name}_saved_by_informed_low95"), middle - half),
        (format!("{name}_saved_by_informed_high95"), middle + half),
    ];
    figures.map(|(name, value)| Metric::new(name, value, "")).into()
}
