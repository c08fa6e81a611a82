use anyhow::Result;
use wayfix_evaluation::report::{Metric, ReportRun};
use wayfix_systems::views::{self, DescriptorKind, ViewsParams};

use super::{scenes::Scenes, settings::Settings};
use crate::regress::PlannedJob;

/// Greedy and informed actions on the same drives through a composed scene.
pub(super) fn choices(job: &PlannedJob<'_>, settings: &Settings) -> Result<ReportRun> {
    let scenes = Scenes::compose(settings)?;
    let greedy = ViewsParams::default();
    let mut informed = greedy.clone();
    informed.navigator.action_selection = views::INFORMED;
    let mut metrics = Vec::new();
    for &normalization in &settings.normalization {
        for feature in DescriptorKind::OF_THE_PAPER {
            let setup = scenes.setup(feature, normalization);
            let drive = |params| {
                views::run(
                    &scenes.learned,
                    &scenes.real,
                    &setup,
                    params,
                    settings.trials,
                    job.options.seed,
                    &|| (),
                )
            };
            let prefix = format!("{}_{}", feature.name(), normalization.name());
            let named = |metric: Metric| Metric { name: format!("{prefix}_{}", metric.name), ..metric };
            metrics
                .extend(views::compare_choices(&drive(&greedy)?, &drive(&informed)?).into_iter().map(named));
        }
    }
    Ok(ReportRun { metrics, ..ReportRun::default() })
}
