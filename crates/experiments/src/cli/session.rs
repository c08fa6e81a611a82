use std::sync::Mutex;

use anyhow::Result;
use wayfix_evaluation::{
    report::{run_line, table::TableStyle},
    terminal::print,
};

use crate::regress::{
    CampaignShard, CompletedRun, RegressOptions, SeededRun, ShardResults, assemble, thread_seconds,
};

/// The runs of a call that are finished. After each one its line is printed, and the report and the state for `--resume` are written.
pub(super) struct RegressSession<'a> {
    options: &'a RegressOptions,
    shard: CampaignShard,
    state: Mutex<SessionState>,
}

/// A run and the seconds of computing that it took.
type RunCost = (SeededRun, f64);

struct SessionState {
    done: Vec<CompletedRun>,
    /// Seconds of computing of each run; right with one thread only.
    costs: Vec<RunCost>,
    /// Seconds of computing up to the end of the last run.
    computed_s: f64,
    /// The first failure of writing.
    failure: Result<()>,
}

impl<'a> RegressSession<'a> {
    pub(super) fn new(options: &'a RegressOptions, shard: CampaignShard, done: Vec<CompletedRun>) -> Self {
        Self {
            options,
            shard,
            state: Mutex::new(SessionState { done, costs: Vec::new(), computed_s: 0.0, failure: Ok(()) }),
        }
    }

    /// Takes a finished run in.
    pub(super) fn add(&self, run: CompletedRun) {
        let mut state = self.state.lock().unwrap_or_else(std::sync::PoisonError::into_inner);
        let cell = run.cell.clone();
        let cost = thread_seconds() - state.computed_s;
        state.costs.push((cell.clone(), cost));
        state.done.push(run);
        if state.failure.is_ok() {
            state.failure = self.write(&state.done, (&cell.suite, &cell.run));
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

    /// All runs that are finished, and what those of this call cost.
    ///
    /// # Errors
    /// Returns the first failure of writing.
    pub(super) fn finish(self) -> Result<(Vec<CompletedRun>, Vec<RunCost>)> {
        let SessionState { done, costs, failure, .. } =
            self.state.into_inner().unwrap_or_else(std::sync::PoisonError::into_inner);
        failure.map(|()| (done, costs))
    }
}
