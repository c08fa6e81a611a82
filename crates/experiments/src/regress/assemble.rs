use anyhow::Result;
use wayfix_evaluation::report::{FullReport, MachineInfo, ReportRun, ReportSuite, commit};

use super::{
    CampaignShard, CompletedRun, MetricBound, PlannedRun, ReferenceFigures, RegressOptions, SeededRun,
    SuitePlan, cells, over_seeds::over_seeds, plan::judge,
};

/// The report of all runs in `done`, in the order of the plans: figures over all seeds, with a verdict for each. Other runs are `pending`.
///
/// # Errors
/// Returns an error if a plan or the blessed figures cannot be read or written.
pub(crate) fn assemble(
    options: &RegressOptions,
    shard: CampaignShard,
    done: &[CompletedRun],
) -> Result<FullReport> {
    let is_pending = |cell: &SeededRun| !done.iter().any(|done| done.cell == *cell);
    let pending: Vec<SeededRun> = shard.share(cells(options)?).into_iter().filter(is_pending).collect();
    let suites = options.selection.suites.iter();
    let suites = suites.map(|suite| assemble_suite(options, suite, done, pending.is_empty()));
    Ok(FullReport {
        suites: suites.collect::<Result<_>>()?,
        pending: pending.iter().map(|cell| format!("{} / {}", cell.suite, cell.run)).collect(),
        seed: options.seed,
        commit: commit(&options.fixtures),
        machine: MachineInfo::detect(),
    })
}

fn assemble_suite(
    options: &RegressOptions,
    suite: &str,
    done: &[CompletedRun],
    is_complete: bool,
) -> Result<ReportSuite> {
    let plan = SuitePlan::read(&options.fixtures, suite)?;
    let of_plan = |planned: &PlannedRun| {
        let is_of = |done: &&CompletedRun| done.cell.suite == suite && done.cell.run == planned.name;
        let mut of_seeds: Vec<&CompletedRun> = done.iter().filter(is_of).collect();
        of_seeds.sort_by_key(|done| done.cell.seed);
        let mut run = over_seeds(&of_seeds)?;
        let is_timed = |bound: &MetricBound| run.timings.iter().any(|timing| timing.name == bound.metric);
        let (of_timings, of_metrics): (Vec<_>, Vec<_>) = planned.bound.iter().cloned().partition(is_timed);
        judge(&of_metrics, &mut run.metrics);
        judge(&of_timings, &mut run.timings);
        run.notes.extend(planned.note.clone());
        Some(run)
    };
    let mut runs: Vec<ReportRun> = plan.run.iter().filter_map(of_plan).collect();

    let blessed_path = options.fixtures.join(format!("{suite}-figures.json"));
    let stored: Vec<&str> =
        plan.run.iter().filter(|run| run.data.is_none()).map(|run| run.name.as_str()).collect();
    if options.bless && is_complete {
        ReferenceFigures::write(
            &blessed_path,
            runs.iter().filter(|run| stored.contains(&run.name.as_str())),
        )?;
    }
    if options.n_seeds <= 1 {
        let blessed = ReferenceFigures::read(&blessed_path)?;
        for run in &mut runs {
            let changed = blessed.compare(run);
            run.metrics.extend(changed);
        }
    }
    let means: Vec<ReportRun> = plan.mean.iter().filter_map(|mean| mean.over(&runs)).collect();
    runs.extend(means);
    Ok(ReportSuite { name: suite.to_owned(), runs })
}
