use std::{path::Path, process::ExitCode};

use anyhow::{Context, Result, bail, ensure};
use wayfix_evaluation::terminal::{self, print, print_message};
use wayfix_sensor_log::{Data, Format, ReadReport, Record, read_relations};

use super::super::{
    input::{name_of, read_toml},
    outputs::Outputs,
    read_problems::add_read_problems,
};
use super::run_slam;
use crate::commented::commented;
use wayfix_evaluation::report::Run;
use wayfix_systems::{
    slam::{AssociationRule, Saved, Saver},
    system::{DriveStep, Stopwatch},
    walls::{self, WallEstimateLog, WallSlamParams, WallState, WallSystem},
};

/// Whether a log is one of scans: walls are its landmarks then.
pub(in crate::cli) fn is_for(records: &[Record]) -> bool {
    let has = |is: fn(&Data) -> bool| records.iter().any(|record| is(&record.data));
    has(|data| matches!(data, Data::Scan(_))) && !has(|data| matches!(data, Data::Detections(_)))
}

/// `wayfix run slam` on a log of scans.
pub(in crate::cli) fn main(
    arguments: &run_slam::Arguments,
    records: &[Record],
    origin: Format,
    read: &ReadReport,
) -> Result<ExitCode> {
    ensure!(
        arguments.profile.is_none(),
        "--profile is for logs of range-bearing detections; this one has laser scans"
    );
    let params = params(arguments)?;
    if arguments.common.print_params {
        print(commented(&params)?)?;
        return Ok(ExitCode::SUCCESS);
    }
    let mut outputs = Outputs::open("slam", &arguments.common)?;
    let mut estimates: Option<WallEstimateLog> = outputs.estimates(origin)?;
    let stopwatch = Stopwatch::start();
    let mut saver = arguments.save.clone().map(|path| Saver::new(path, arguments.save_every));
    let bar = terminal::bar(records.len(), "EKF-SLAM with walls");
    let observe = |DriveStep { system, record, next }: DriveStep<'_, WallSystem>| {
        if let Some(estimates) = &mut estimates {
            estimates.observe(record, system);
        }
        if let Some(saver) = &mut saver {
            saver.observe(record, next, system);
        }
        bar.inc(1);
    };
    let slam = match arguments.resume.as_deref().map(saved_map).transpose()? {
        Some(saved) => walls::run_on(saved, records, &params, arguments.association, observe),
        None => walls::run(records, &params, observe),
    };
    bar.finish_and_clear();
    let mut slam = slam?;
    if let Some(saver) = saver {
        saver.finish(&slam.system).context("cannot save the map")?;
    }
    if let Some(estimates) = estimates {
        estimates.finish()?;
    }
    let warnings = add_read_problems(slam.events(), read);
    let mut run = Run {
        name: name_of(&arguments.log),
        seconds: stopwatch.elapsed().as_secs_f64(),
        warnings,
        ..walls::summarize(&mut slam)
    };
    if let Some(path) = &arguments.relations {
        let (relations, read) = read_relations(path)?;
        if !read.is_clean() {
            print_message(&read);
        }
        run.metrics.extend(walls::relation_metrics(&slam, &relations));
    }
    run.notes.iter().for_each(print_message);
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
    params.record_observability = arguments.observability;
    Ok(params)
}

fn saved_map(path: &Path) -> Result<Saved<WallState>> {
    Saved::read(path).with_context(|| format!("cannot go on from {}", path.display()))
}
