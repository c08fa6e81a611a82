use anyhow::Result;
use wayfix_evaluation::report::ReportRun;

use super::{
    choices::choices,
    drive::drive,
    scenes::Scenes,
    settings::{Experiment, Settings},
    tables::tables,
};
use crate::regress::PlannedJob;

/// An experiment with views.
pub(in crate::regress::suites) fn run(job: &PlannedJob<'_>) -> Result<ReportRun> {
    let settings: Settings = job.planned.settings()?;
    match settings.experiment {
        Experiment::Drive => {
            let scenes = Scenes::read(job, &settings)?;
            drive(job, &settings, &scenes, |_, _| Ok(Vec::new()), |_, metric| metric)
        }
        Experiment::Tables => tables(job, &settings),
        Experiment::Choices => choices(job, &settings),
        Experiment::Corridor => crate::corridor::run(job.log()?),
        Experiment::CorridorLog => crate::corridor::run_logged(job.log()?),
    }
}
