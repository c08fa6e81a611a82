use anyhow::Result;
use wayfix_evaluation::report::{Metric, ReportRun};
use wayfix_systems::views::{self, DescriptorKind, ViewSystem, ViewSystemConfig};

use super::{scenes::Scenes, settings::Settings};
use crate::regress::PlannedJob;

/// The paper's features with every normalization, on one scene. Figures are named after both; pictures are those of the last.
pub(super) fn drive(
    job: &PlannedJob<'_>,
    settings: &Settings,
    scenes: &Scenes,
    statistics: impl Fn(&ViewSystemConfig, &ViewSystem) -> Result<Vec<Metric>>,
    beside: impl Fn(&ViewSystemConfig, Metric) -> Metric,
) -> Result<ReportRun> {
    let (params, seed) = (settings.params(), job.options.seed);
    let mut all = ReportRun {
        notes: vec!["The pictures are of the last feature and normalization.".to_owned()],
        ..ReportRun::default()
    };
    let mut last = None;
    for &normalization in &settings.normalization {
        for feature in DescriptorKind::OF_THE_PAPER {
            let setup = scenes.setup(feature, normalization);
            let run =
                views::run(&scenes.learned, &scenes.real, &setup, &params, settings.trials, seed, &|| ())?;
            let prefix = format!("{}_{}", feature.name(), normalization.name());
            let summary = views::summarize(&run);
            let named = |metric: Metric| {
                let metric = beside(&setup, metric);
                Metric { name: format!("{prefix}_{}", metric.name), ..metric }
            };
            let is_told = |metric: &Metric| TOLD.contains(&metric.name.as_str());
            all.metrics.extend(summary.metrics.into_iter().filter(is_told).map(named));
            all.metrics.extend(statistics(&setup, &run.system)?.into_iter().map(named));
            let events = summary.events.into_iter().filter(|(name, n)| name != "arrived_at_goal" && *n > 0);
            all.events.extend(events.map(|(name, n)| (format!("{prefix}_{name}"), n)));
            all.notes.extend(summary.notes.into_iter().map(|note| format!("{prefix}: {note}")));
            last = Some(run);
        }
    }
    if let Some(run) = last {
        all.figures = views::plots(&run, &scenes.learned, &scenes.real, seed)?;
    }
    Ok(all)
}

/// Figures of a drive that the report shows.
const TOLD: [&str; 3] = ["successes", "steps_mean", "steps_to_certainty_mean"];
