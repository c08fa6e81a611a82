use anyhow::Result;
use serde::{Deserialize, Serialize};

use super::{PlannedJob, PlannedRun, RegressOptions, SuitePlan};

/// One run with one seed: the piece of work that a shard takes or leaves.
#[derive(Clone, Debug, PartialEq, Eq, PartialOrd, Ord, Serialize, Deserialize)]
pub(crate) struct SeededRun {
    /// Name of the suite.
    pub suite: String,
    /// Name of the planned run.
    pub run: String,
    /// Seed of every generator.
    pub seed: u64,
}

/// All requested work, in the order of the report: run by run, seed by seed.
/// # Errors
/// Returns an error if a plan cannot be read.
pub(crate) fn cells(options: &RegressOptions) -> Result<Vec<SeededRun>> {
    let mut cells = Vec::new();
    for suite in &options.selection.suites {
        let plan = SuitePlan::read(&options.fixtures, suite)?;
        let is_wanted =
            |run: &&PlannedRun| options.selection.takes(suite, &run.name) && job(options, run).is_some();
        for run in plan.run.iter().filter(is_wanted) {
            let cell = |seed| SeededRun { suite: suite.clone(), run: run.name.clone(), seed };
            cells.extend(options.seeds().map(cell));
        }
    }
    Ok(cells)
}

/// A run with its inputs; `None` for unavailable recordings and unrequested runs.
pub(super) fn job<'a>(options: &'a RegressOptions, planned: &'a PlannedRun) -> Option<PlannedJob<'a>> {
    let path = match (&planned.log, &planned.data) {
        _ if options.quick && (planned.slow || planned.data.is_some()) => return None,
        (Some(log), _) => Some(options.fixtures.join(log)),
        (None, Some(data)) => Some(options.data.as_ref()?.join(data)).filter(|path| path.exists()),
        (None, None) => None,
    };
    (planned.data.is_none() || path.is_some()).then_some(PlannedJob { options, planned, path })
}
