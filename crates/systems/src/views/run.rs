use std::{
    ops::ControlFlow,
    sync::atomic::{AtomicBool, Ordering},
    time::Duration,
};

use rayon::prelude::*;
use wayfix_condensation::RgbImage;
use wayfix_system_core::Stopwatch;

use super::{ViewSystem, ViewSystemConfig, ViewTrial, ViewsError, ViewsParams};

/// Drives between random places of a learned scene.
#[derive(Clone, Debug)]
pub struct ViewsRun {
    /// The learned and the real scene.
    pub system: ViewSystem,
    /// The trials that were made, in order.
    pub trials: Vec<ViewTrial>,
    /// Duration of learning.
    pub learning: Duration,
    /// Duration of all drives.
    pub driving: Duration,
}

/// Learns `learned`, then drives `n_trials` times through `real`, in parallel; calls `done` after each drive.
///
/// The results do not depend on the number of threads: each drive has its own generator.
///
/// # Errors
/// Returns the errors of [`ViewSystem::learn`].
pub fn run(
    learned: &RgbImage,
    real: &RgbImage,
    setup: &ViewSystemConfig,
    params: &ViewsParams,
    n_trials: u64,
    seed: u64,
    done: &(impl Fn() + Sync),
) -> Result<ViewsRun, ViewsError> {
    let stopwatch = Stopwatch::start();
    let system = ViewSystem::learn(learned, real, setup, params)?;
    let on = || {
        done();
        ControlFlow::Continue(())
    };
    ViewsRun::drive(system, stopwatch.elapsed(), n_trials, seed, &on)
}

impl ViewsRun {
    /// Drives `n_trials` times, in parallel; calls `done` after each drive, which may end the run after the drives
    /// under way. `learning` is the time that learning took.
    ///
    /// # Errors
    /// Returns [`ViewsError::Condensation`].
    pub fn drive(
        system: ViewSystem,
        learning: Duration,
        n_trials: u64,
        seed: u64,
        done: &(impl Fn() -> ControlFlow<()> + Sync),
    ) -> Result<Self, ViewsError> {
        let stopwatch = Stopwatch::start();
        let has_ended = AtomicBool::new(false);
        let trial = |index: u64| {
            if has_ended.load(Ordering::Relaxed) {
                return None;
            }
            let trial = system.trial(seed, index, |_| {});
            if done().is_break() {
                has_ended.store(true, Ordering::Relaxed);
            }
            Some(trial)
        };
        let trials = (0..n_trials).into_par_iter().filter_map(trial).collect::<Result<Vec<_>, _>>()?;
        Ok(Self { system, trials, learning, driving: stopwatch.elapsed() })
    }
}
