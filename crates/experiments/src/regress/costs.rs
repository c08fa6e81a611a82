use std::{collections::BTreeMap, fs, hint::black_box, path::Path};

use anyhow::{Context, Result};
use serde::{Deserialize, Serialize};

use super::{RegressOptions, SeededRun};

/// How long each run takes: `costs.json` beside the plans.
///
/// The seconds are those of the machine that measured them. A short computation that was timed there and is timed here scales them.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub(crate) struct RunCosts {
    /// Seconds of the short computation on that machine.
    calibration_s: f64,
    /// Seconds of each run with the stored logs only, as `suite/run`.
    quick: BTreeMap<String, f64>,
    /// The same of each experiment in full size.
    full: BTreeMap<String, f64>,
}

/// An estimate of the time that some runs take here.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub(crate) struct EstimatedTime {
    /// Number of runs.
    pub n_runs: usize,
    /// Seconds of computing of the runs whose cost is known.
    pub seconds: f64,
    /// Number of runs whose cost is not known.
    pub n_unknown: usize,
}

impl EstimatedTime {
    /// The estimate in words, for `n_threads` at a time.
    pub(crate) fn told(&self, n_threads: usize) -> String {
        let Self { n_runs, seconds, n_unknown } = *self;
        let minutes = seconds / n_threads.max(1) as f64 / 60.0;
        let known = format!("about {minutes:.1} minutes on {n_threads} threads");
        let time = match n_unknown {
            _ if n_runs == 0 => "nothing to do".to_owned(),
            0 => known,
            n if n == n_runs => "not timed yet".to_owned(),
            n => format!("{known}, {n} of them not timed yet"),
        };
        format!("{n_runs} {}, {time}", if n_runs == 1 { "run" } else { "runs" })
    }
}

const FILE: &str = "costs.json";

impl RunCosts {
    /// Reads the costs; empty if the file does not exist.
    /// # Errors
    /// Returns an error if the file is there and cannot be read.
    pub(crate) fn read(fixtures: &Path) -> Result<Self> {
        let path = fixtures.join(FILE);
        if !path.exists() {
            return Ok(Self::default());
        }
        let text = fs::read_to_string(&path).with_context(|| format!("cannot read {}", path.display()))?;
        serde_json::from_str(&text).with_context(|| format!("{} is not usable", path.display()))
    }

    /// Computing time of `runs` here, if the short computation takes `calibration_s` here.
    pub(crate) fn estimate(&self, quick: bool, runs: &[SeededRun], calibration_s: f64) -> EstimatedTime {
        let costs = if quick { &self.quick } else { &self.full };
        let known: Vec<f64> = runs.iter().filter_map(|run| costs.get(&name(run)).copied()).collect();
        let is_known = self.calibration_s > 0.0 && calibration_s > 0.0;
        let factor = if is_known { calibration_s / self.calibration_s } else { 1.0 };
        EstimatedTime {
            n_runs: runs.len(),
            seconds: factor * known.iter().sum::<f64>(),
            n_unknown: runs.len() - known.len(),
        }
    }

    /// Stores the seconds of computing of `runs` beside the plans, and keeps those of other runs.
    ///
    /// # Errors
    /// Returns an error if the file cannot be read or written.
    pub(crate) fn store(
        options: &RegressOptions,
        runs: &[(SeededRun, f64)],
        calibration_s: f64,
    ) -> Result<()> {
        let mut all = Self::read(&options.fixtures)?;
        let factor = if all.calibration_s > 0.0 { all.calibration_s / calibration_s } else { 1.0 };
        if all.calibration_s <= 0.0 {
            all.calibration_s = calibration_s;
        }
        let costs = if options.quick { &mut all.quick } else { &mut all.full };
        // Three digits: more would be noise.
        let round = |seconds: f64| (1e3 * factor * seconds).round() / 1e3;
        costs.extend(runs.iter().map(|(run, seconds)| (name(run), round(*seconds))));
        let path = options.fixtures.join(FILE);
        let text = serde_json::to_string_pretty(&all)? + "\n";
        fs::write(&path, text).with_context(|| format!("cannot write {}", path.display()))
    }
}

fn name(run: &SeededRun) -> String {
    format!("{}/{}", run.suite, run.run)
}

/// Seconds that this thread has computed so far, which other programs do not lengthen; 0 where the system does not report it.
pub(crate) fn thread_seconds() -> f64 {
    let text = fs::read_to_string("/proc/thread-self/schedstat").unwrap_or_default();
    let nanoseconds = text.split_whitespace().next().and_then(|word| word.parse::<f64>().ok());
    nanoseconds.map_or(0.0, |nanoseconds| 1e-9 * nanoseconds)
}

/// Seconds of a short computation, the shortest of several: the measure of a machine. 0 where the system does not report it.
pub(crate) fn calibration_seconds() -> f64 {
    const REPEATS: usize = 5;
    let once = |_| {
        let start = thread_seconds();
        let mut x = 0.5;
        for _ in 0..3_000_000 {
            x = black_box(3.9 * x * (1.0 - x)); // Each step waits for the one before, however the compiler optimizes.
        }
        thread_seconds() - start
    };
    (0..REPEATS).map(once).fold(f64::INFINITY, f64::min)
}

#[cfg(test)]
mod tests {
    use super::*;
    use approx::assert_abs_diff_eq;

    fn run(name: &str) -> SeededRun {
        SeededRun { suite: "slam".to_owned(), run: name.to_owned(), seed: 1 }
    }

    #[test]
    fn a_slow_machine_takes_longer_and_unknown_runs_count() {
        let full = [("slam/a".to_owned(), 3.0), ("slam/b".to_owned(), 1.0)].into();
        let costs = RunCosts { calibration_s: 0.1, full, ..RunCosts::default() };
        let estimate = costs.estimate(false, &[run("a"), run("b"), run("c")], 0.2);
        assert_eq!((estimate.n_runs, estimate.n_unknown), (3, 1));
        assert_abs_diff_eq!(estimate.seconds, 8.0, epsilon = 1e-12);
        assert_eq!(costs.estimate(true, &[run("a")], 0.2).n_unknown, 1);
    }

    #[test]
    fn a_thread_computes_forward() {
        let before = thread_seconds();
        assert!(calibration_seconds().is_finite() && thread_seconds() >= before);
    }
}
