use super::CompletedRun;
use wayfix_evaluation::{
    errors::MeanInterval,
    report::{ConfidenceInterval, Metric, ReportRun},
};

/// Merges one run over several seeds: means with their intervals, sums of events; pictures and the log of the first. `None` if empty.
pub(super) fn over_seeds(done: &[&CompletedRun]) -> Option<ReportRun> {
    let (first, others) = done.split_first()?;
    if others.is_empty() {
        return Some(first.run.clone());
    }
    let mut run = first.run.clone();
    run.metrics = means(done, |run| &run.metrics);
    run.timings = means(done, |run| &run.timings);
    for other in others {
        run.seconds += other.run.seconds;
        for (event, count) in &other.run.events {
            *run.events.entry(event.clone()).or_default() += count;
        }
        run.error = run.error.or_else(|| {
            other.run.error.as_ref().map(|error| format!("with seed {}: {error}", other.cell.seed))
        });
    }
    let last = done.last().map_or(first.cell.seed, |done| done.cell.seed);
    run.notes.insert(
        0,
        format!(
            "Means over {} seeds, {} to {last}, with 95 % intervals; events are summed, pictures are of the first seed.",
            done.len(),
            first.cell.seed
        ),
    );
    Some(run)
}

/// The mean of every figure of the first run; not a number where a seed lacks it.
fn means(done: &[&CompletedRun], figures: impl Fn(&ReportRun) -> &Vec<Metric>) -> Vec<Metric> {
    let mean = |metric: &Metric| {
        let of_seed = |done: &&CompletedRun| {
            let found = figures(&done.run).iter().find(|other| other.name == metric.name);
            found.map_or(f64::NAN, |found| found.value)
        };
        let values: Vec<f64> = done.iter().map(of_seed).collect();
        match MeanInterval::of(&values) {
            Some(MeanInterval { mean, half_width, n }) => {
                Metric { value: mean, spread: Some(ConfidenceInterval { half_width, n }), ..metric.clone() }
            }
            None => metric.clone(),
        }
    };
    figures(&done[0].run).iter().map(mean).collect()
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::regress::SeededRun;
    use approx::assert_abs_diff_eq;

    fn done(seed: u64, value: f64) -> CompletedRun {
        let cell = SeededRun { suite: "s".to_owned(), run: "r".to_owned(), seed };
        let events = [("lost".to_owned(), seed)].into();
        let run = ReportRun {
            metrics: vec![Metric::new("error_m", value, "m")],
            seconds: 1.0,
            events,
            ..ReportRun::default()
        };
        CompletedRun { cell, run }
    }

    #[test]
    fn figures_are_means_with_intervals_and_events_are_sums() {
        let done = [done(1, 0.9), done(2, 1.0), done(3, 0.8), done(4, 0.9)];
        let run = over_seeds(&done.iter().collect::<Vec<_>>()).unwrap();
        let spread = run.metrics[0].spread.unwrap();
        assert_abs_diff_eq!(run.metrics[0].value, 0.9, epsilon = 1e-12);
        assert!(spread.n == 4);
        assert_abs_diff_eq!(spread.half_width, 0.1299, epsilon = 1e-4); // t(0.975, 3) = 3.182 times 0.0816 / √4
        assert_eq!((run.events["lost"], run.seconds), (10, 4.0));
    }

    #[test]
    fn a_figure_that_one_seed_lacks_fails() {
        let mut without = done(2, 1.0);
        without.run.metrics.clear();
        let run = over_seeds(&[&done(1, 1.0), &without]).unwrap();
        assert!(run.metrics[0].value.is_nan());
        assert_eq!(over_seeds(&[]), None);
        assert_eq!(over_seeds(&[&done(1, 2.0)]).unwrap(), done(1, 2.0).run);
    }
}
