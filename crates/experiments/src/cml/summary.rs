use std::sync::atomic::{AtomicUsize, Ordering};

use anyhow::Result;
use rayon::prelude::*;
use wayfix_evaluation::errors::MeanInterval;
use wayfix_evaluation::report::Metric;
use wayfix_evaluation::terminal::print_message;

use super::CmlExperimentSetup;

/// Does an experiment with every seed, side by side; the results in the order of the seeds. Says when each is done: one may take minutes; `what` is the experiment.
pub(super) fn over_seeds<T: Send>(
    what: &str,
    setup: &CmlExperimentSetup,
    seed: u64,
    one: impl Fn(u64) -> Result<T> + Sync,
) -> Result<Vec<T>> {
    let seeds: Vec<u64> = setup.seeds(seed).collect();
    let (n_seeds, n_done) = (seeds.len(), AtomicUsize::new(0));
    let told = |seed: u64| {
        let result = one(seed)?;
        let n_done = 1 + n_done.fetch_add(1, Ordering::Relaxed);
        if n_seeds > 1 {
            print_message(format!("{what}: {n_done} of {n_seeds} worlds done"));
        }
        Ok(result)
    };
    seeds.into_par_iter().map(told).collect()
}

/// The mean over seeds, and, from two on, half the width of its 95 % interval.
pub(super) fn mean_of<T>(name: &str, unit: &str, seeds: &[T], value: impl Fn(&T) -> f64) -> Vec<Metric> {
    let values: Vec<f64> = seeds.iter().map(value).collect();
    let mean = values.iter().sum::<f64>() / values.len() as f64;
    let interval = MeanInterval::of(&values)
        .map(|interval| Metric::new(format!("{name}_ci95"), interval.half_width, unit));
    [Metric::new(name, mean, unit)].into_iter().chain(interval).collect()
}

/// The mean of the one over the seeds against that of the other, and, from two on, half the width of its 95 % interval.
pub(super) fn ratio_of<T>(
    name: &str,
    seeds: &[T],
    numerator: impl Fn(&T) -> f64,
    denominator: impl Fn(&T) -> f64,
) -> Vec<Metric> {
    let above: Vec<f64> = seeds.iter().map(numerator).collect();
    let below: Vec<f64> = seeds.iter().map(denominator).collect();
    match MeanInterval::of_ratio(&above, &below) {
        Some(interval) => Metric::of_mean(name, &interval, "").into(),
        None => vec![Metric::new(name, mean(&above) / mean(&below), "")],
    }
}

pub(super) fn mean(values: &[f64]) -> f64 {
    values.iter().sum::<f64>() / values.len() as f64
}

pub(super) fn largest(values: &[f64]) -> f64 {
    values.iter().copied().fold(f64::NAN, f64::max)
}

/// One diverged world dominates a mean of ten, so list them separately.
pub(super) fn by_seed<'a>(what: &str, errors: impl Iterator<Item = &'a [f64]>) -> String {
    let figures: Vec<String> =
        errors.map(|errors| format!("{:.2} ({:.1})", mean(errors), largest(errors))).collect();
    format!("{what}, mean (largest) error seed by seed, m: {}.", figures.join(", "))
}
