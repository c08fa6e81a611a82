use std::{path::Path, process::ExitCode};

use anyhow::{Context, Result, bail, ensure};
use wayfix_evaluation::terminal::{print, print_message};
use wayfix_sensor_log::{Log, LogError, LogFormat, PoseRelation, Record, RecordData, read_relations};
use wayfix_slam_system::{
    slam::AssociationRule,
    walls::{self, SavedWallMap, WallSlamParams},
};
use wayfix_system_core::{LogOverview, settings::from_toml, without_odometry_delay};

use super::{
    super::parameter_file::read_toml,
    run_slam::{self, EstimatorName},
};
use crate::commented::commented;

/// Whether a log is one of scans: walls are its landmarks then.
pub(in crate::cli) fn is_for(records: &[Record]) -> bool {
    let has = |is: fn(&RecordData) -> bool| records.iter().any(|record| is(&record.data));
    has(|data| matches!(data, RecordData::Scan(_))) && !has(|data| matches!(data, RecordData::Detections(_)))
}

/// A log of scans.
pub(in crate::cli) struct Input {
    pub(in crate::cli) overview: LogOverview,
    /// Whether it is the whole log; else the log is read again.
    pub(in crate::cli) is_kept: bool,
    pub(in crate::cli) origin: LogFormat,
}

/// `wayfix run slam` on a log of scans, which `open` opens again.
pub(in crate::cli) fn main(
    arguments: &run_slam::Arguments,
    Input { overview, is_kept, origin }: Input,
    open: &dyn Fn() -> Result<Log, LogError>,
) -> Result<ExitCode> {
    ensure!(
        arguments.profile.is_none(),
        "--profile is for logs of range-bearing detections; this one has laser scans"
    );
    ensure!(
        arguments.estimator == EstimatorName::Ekf,
        "walls need --estimator ekf: the smoother takes points and ranges"
    );
    let params = params(arguments)?;
    if arguments.common.print_params {
        print(commented(&params)?)?;
        return Ok(ExitCode::SUCCESS);
    }
    let saved: Option<SavedWallMap> = arguments.saved_map()?;
    let relations = arguments.relations.as_deref().map(relations).transpose()?;
    let rule = arguments.association;
    run_slam::execute(
        arguments,
        (origin, overview.n_records, &overview.read),
        |observe| {
            // What is to be sorted is kept.
            if is_kept || params.odometry_delay != 0.0 {
                let read_again;
                let records = if is_kept {
                    &overview.records
                } else {
                    read_again = open()?.read_all().0;
                    &read_again
                };
                let in_time = without_odometry_delay(records, params.odometry_delay);
                return match saved {
                    Some(saved) => walls::run_on(saved, records, in_time.iter(), &params, rule, observe),
                    None => walls::run_streamed(records, in_time.iter(), &params, observe),
                };
            }
            let known = &overview.records;
            match saved {
                Some(saved) => walls::run_on(saved, known, open()?, &params, rule, observe),
                None => walls::run_streamed(known, open()?, &params, observe),
            }
        },
        |run| {
            let mut summary = walls::summarize(run);
            summary.metrics.extend(relations.iter().flat_map(|known| walls::relation_metrics(run, known)));
            Ok(summary)
        },
        walls::plots,
    )
}

fn relations(path: &Path) -> Result<Vec<PoseRelation>> {
    let (relations, read) = read_relations(path)?;
    if !read.is_clean() {
        print_message(&read);
    }
    Ok(relations)
}

fn params(arguments: &run_slam::Arguments) -> Result<WallSlamParams> {
    let mut params = match &arguments.common.params {
        Some(path) => read_toml(path, "walls", from_toml::<WallSlamParams>)?
            .validated()
            .with_context(|| format!("parameters in {} are not usable", path.display()))?,
        None => WallSlamParams::default(),
    };
    match arguments.association {
        Some(AssociationRule::Known) => {
            bail!("walls have no identities: use --association nn or jcbb")
        }
        Some(rule) => params.association = rule,
        None => {}
    }
    params.record_observability = arguments.observability;
    Ok(params)
}
