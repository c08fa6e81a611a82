use std::sync::Mutex;

use anyhow::Result;
use wayfix_evaluation::{
    report::{run_line, table::TableStyle},
    terminal::print,
};

use crate::regress::{
    CampaignShard, CompletedRun, RegressOptions, RunCosts, ShardResults, assemble, thread_seconds,
};

/// The runs of a call that are finished. After each one its line is printed, and the report and the state for `--resume` are written.
pub(super) struct RegressSession<'a> {
    options: &'a RegressOptions,
    shard: CampaignShard,
    /// Seconds of the short computation by which costs are scaled, if the cost of each run is stored.
    calibration_s: Option<f64>,
    state: Mutex<SessionState>,
}

struct SessionState {
    done: Vec<CompletedRun>,
    /// Seconds of computing up to the end of the last run.
    computed_s: f64,
    /// The first failure of writing.
    failure: Result<()>,
}

impl<'a> RegressSession<'a> {
    pub(super) fn new(options: &'a RegressOptions, shard: CampaignShard, done: Vec<CompletedRun>) -> Self {
        let state = Mutex::new(SessionState { done, computed_s: 0.0, failure: Ok(()) });
        Self { options, shard, calibration_s: None, state }
    }

    /// Stores what each run costs as soon as it ends; right with one thread only.
    pub(super) fn storing_costs(self, calibration_s: f64) -> Self {
        Self { calibration_s: Some(calibration_s), ..self }
    }

    /// Takes a finished run in.
    pub(super) fn add(&self, run: CompletedRun) {
        let mut state = self.state.lock().unwrap_or_else(std::sync::PoisonError::into_inner);
        let cell = run.cell.clone();
        let cost = thread_seconds() - state.computed_s;
        state.done.push(run);
        if state.failure.is_ok() {
            let stored = self.calibration_s.map_or(Ok(()), |calibration_s| {
                RunCosts::store(self.options, &[(cell.clone(), cost)], calibration_s)
            });
            state.failure = stored.and_then(|()| self.write(&state.done, (&cell.suite, &cell.run)));
        }
        state.computed_s = thread_seconds();
    }

    fn write(&self, done: &[CompletedRun], (suite, run): (&str, &str)) -> Result<()> {
        let options = RegressOptions { bless: false, ..self.options.clone() };
        ShardResults::new(&options, self.shard, done)?.write(&options.out)?;
        let report = assemble(&options, self.shard, done)?;
        if !self.shard.is_part() {
            report.write(&options.out)?;
        }
        let suites = report.suites.iter().filter(|found| found.name == suite);
        let found = suites.flat_map(|found| &found.runs).find(|found| found.name == run);
        found.map_or(Ok(()), |found| print(run_line(suite, found, TableStyle::of_stdout())))
    }

    /// All runs that are finished.
    ///
    /// # Errors
    /// Returns the first failure of writing.
    pub(super) fn finish(self) -> Result<Vec<CompletedRun>> {
        let SessionState { done, failure, .. } =
            self.state.into_inner().unwrap_or_else(std::sync::PoisonError::into_inner);
        failure.map(|()| done)
    }
}
