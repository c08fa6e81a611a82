use anyhow::Result;
use wayfix_evaluation::report::{Metric, ReportRun};
use wayfix_systems::views::{self, LightNormalization, ViewSystem, ViewSystemConfig};

use super::{drive::drive, scenes::Scenes, settings::Settings};
use crate::PaperSceneRows;
use crate::regress::PlannedJob;

/// The paper's three tables on a composed scene. [Kasprzak & Szynkiewicz, Tables 1–3] Its figures are compared with ours for the whole-scene
/// normalization, which it assumes.
pub(super) fn tables(job: &PlannedJob<'_>, settings: &Settings) -> Result<ReportRun> {
    let scenes = Scenes::compose(settings)?;
    let paper = PaperSceneRows::named(settings.scene()?);
    let statistics = |setup: &ViewSystemConfig, system: &ViewSystem| match setup.normalization {
        // With several lights, a view is not compared with the learned features of the first one.
        LightNormalization::Online => Ok(Vec::new()),
        LightNormalization::None | LightNormalization::WholeScene => Ok(views::p_value_metrics(system)?),
    };
    let beside = |setup: &ViewSystemConfig, metric: Metric| match (paper, setup.normalization) {
        (Some(paper), LightNormalization::WholeScene) => paper.beside(setup.feature, metric),
        _ => metric,
    };
    drive(job, settings, &scenes, statistics, beside)
}
