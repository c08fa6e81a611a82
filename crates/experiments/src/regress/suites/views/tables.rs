use anyhow::Result;

use super::{drive::drive, scenes::Scenes, settings::Settings};
use crate::PaperScene;
use crate::regress::Job;
use wayfix_evaluation::report::{Metric, Run};
use wayfix_systems::views::{self, Normalization, Setup, ViewSystem};

/// The paper's three tables on a composed scene. Its figures are compared with ours for the whole-scene normalization, which it assumes.
pub(super) fn tables(job: &Job<'_>, settings: &Settings) -> Result<Run> {
    let scenes = Scenes::compose(settings)?;
    let paper = PaperScene::named(settings.scene()?);
    let statistics = |setup: &Setup, system: &ViewSystem| match setup.normalization {
        // With several lights, a view is not compared with the learned features of the first one.
        Normalization::Online => Ok(Vec::new()),
        Normalization::None | Normalization::WholeScene => Ok(views::p_value_metrics(system)?),
    };
    let beside = |setup: &Setup, metric: Metric| match (paper, setup.normalization) {
        (Some(paper), Normalization::WholeScene) => paper.beside(setup.feature, metric),
        _ => metric,
    };
    drive(job, settings, &scenes, statistics, beside)
}
