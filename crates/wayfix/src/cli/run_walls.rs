use std::process::ExitCode;

use anyhow::{Context, Result, bail, ensure};
use wayfix_sensor_log::{Data, Format, ReadReport, Record, read_relations};

use super::{
    account::account,
    input::{name_of, read_toml},
    output::{print, tell},
    outputs::Outputs,
    progress, run_slam,
};
use crate::{
    commented::commented,
    report::Run,
    slam::AssociationRule,
    system::Stopwatch,
    walls::{self, WallEstimateLog, WallSlamParams},
};

/// Whether a log is one of scans: walls are its landmarks then.
pub(super) fn is_for(records: &[Record]) -> bool {
    let has = |is: fn(&Data) -> bool| records.iter().any(|record| is(&record.data));
    has(|data| matches!(data, Data::Scan(_))) && !has(|data| matches!(data, Data::Sightings(_)))
}

/// `wayfix run slam` on a log of scans.
pub(super) fn main(
    arguments: &run_slam::Arguments,
    records: &[Record],
    origin: Format,
    read: &ReadReport,
) -> Result<ExitCode> {
    for (given, option) in [
        (arguments.save.is_some(), "--save"),
        (arguments.resume.is_some(), "--resume"),
        (arguments.observability, "--observability"),
        (arguments.profile.is_some(), "--profile"),
    ] {
        ensure!(!given, "{option} is for logs of range-bearing sightings; this one has laser scans");
    }
    let params = params(arguments)?;
    if arguments.common.print_params {
        print(commented(&params)?)?;
        return Ok(ExitCode::SUCCESS);
    }
    let mut outputs = Outputs::open("slam", &arguments.common)?;
    let mut estimates: Option<WallEstimateLog> = outputs.estimates(origin)?;
    let stopwatch = Stopwatch::start();
    let bar = progress::bar(records.len(), "EKF-SLAM with walls");
    let mut remaining = records.iter();
    let slam = walls::run(records, &params, |system| {
        if let (Some(estimates), Some(record)) = (&mut estimates, remaining.next()) {
            estimates.observe(record, system);
        }
        bar.inc(1);
    });
    bar.finish_and_clear();
    let mut slam = slam?;
    if let Some(estimates) = estimates {
        estimates.finish()?;
    }
    account(slam.events(), read);
    let mut run = Run {
        name: name_of(&arguments.log),
        seconds: stopwatch.elapsed().as_secs_f64(),
        ..walls::summarize(&mut slam)
    };
    if let Some(path) = &arguments.relations {
        let (relations, read) = read_relations(path)?;
        if !read.is_clean() {
            tell(&read);
        }
        run.metrics.extend(walls::relation_metrics(&slam, &relations));
    }
    outputs.show(run, || Ok(walls::pictures(&slam)?))?;
    Ok(ExitCode::SUCCESS)
}

fn params(arguments: &run_slam::Arguments) -> Result<WallSlamParams> {
    let mut params = match &arguments.common.params {
        Some(path) => read_toml(path, WallSlamParams::from_toml)?
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
    Ok(params)
}
