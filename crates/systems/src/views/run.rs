use std::time::Duration;

use rayon::prelude::*;
use wayfix_condensation::Picture;

use super::{Setup, Trial, ViewSystem, ViewsError, ViewsParams};
use crate::system::Stopwatch;

/// Drives between random places of a scene that was learned.
#[derive(Clone, Debug)]
pub struct ViewsRun {
    /// What was learned and is seen.
    pub system: ViewSystem,
    /// In their order.
    pub trials: Vec<Trial>,
    /// How long learning took.
    pub learning: Duration,
    /// How long all drives took.
    pub driving: Duration,
}

/// Learns `learned`, and drives `n_trials` times through `real`, in parallel; `done` is called after each drive.
///
/// The figures do not depend on the number of threads: each drive has a generator of its own.
///
/// # Errors
/// As [`ViewSystem::learn`].
pub fn run(
    learned: &Picture,
    real: &Picture,
    setup: &Setup,
    params: &ViewsParams,
    n_trials: u64,
    seed: u64,
    done: &(impl Fn() + Sync),
) -> Result<ViewsRun, ViewsError> {
    let stopwatch = Stopwatch::start();
    let system = ViewSystem::learn(learned, real, setup, params)?;
    let learning = stopwatch.elapsed();
    let stopwatch = Stopwatch::start();
    let trial = |index: u64| {
        let trial = system.trial(seed, index, |_| {});
        done();
        trial
    };
    let trials = (0..n_trials).into_par_iter().map(trial).collect::<Result<Vec<_>, _>>()?;
    Ok(ViewsRun { system, trials, learning, driving: stopwatch.elapsed() })
}
