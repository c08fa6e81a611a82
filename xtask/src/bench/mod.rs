//! `cargo xtask bench`: every benchmark of the workspace and, with `--peers`, the same jobs in other programs.
//!
//! A benchmark is a command that prints lines `bench<TAB>job<TAB>program<TAB>nanoseconds`; one table compares them.
//! Everything is measured in the same run, since only ratios survive a change of machine or load.

mod jobs;
mod table;

use std::path::PathBuf;
use std::process::{ExitCode, Stdio};

use anyhow::{Context, Result, bail};

use crate::shell;
use table::Measurement;

struct Options {
    peers: bool,
    data: Option<PathBuf>,
    /// Only jobs and programs whose name contains this.
    filter: String,
}

pub(crate) fn run(args: &[String]) -> Result<ExitCode> {
    let options = parse(args)?;
    let mut measurements: Vec<Measurement> = Vec::new();
    let mut failed = Vec::new();
    for job in jobs::all(&options)?.into_iter().filter(|job| job.name.contains(&options.filter)) {
        if let Some(missing) = &job.missing {
            println!("bench: {} skipped: {missing}", job.name);
            continue;
        }
        println!("bench: {}: {}", job.name, shell::spelled(&job.command));
        match measure(job) {
            Ok(measured) => measurements.extend(measured),
            Err((name, error)) => {
                println!("bench: {name} failed: {error:#}");
                failed.push(name);
            }
        }
    }
    print!("\n{}", table::render(&measurements));
    if !failed.is_empty() {
        bail!("failed: {}", failed.join(", "));
    }
    Ok(ExitCode::SUCCESS)
}

fn parse(args: &[String]) -> Result<Options> {
    let data = std::env::var_os("WAYFIX_DATA").map(PathBuf::from);
    let mut options = Options { peers: false, data, filter: String::new() };
    let mut args = args.iter();
    while let Some(arg) = args.next() {
        match arg.as_str() {
            "--peers" => options.peers = true,
            "--data" => options.data = Some(PathBuf::from(args.next().context("--data needs a folder")?)),
            filter if !filter.starts_with('-') => filter.clone_into(&mut options.filter),
            _ => bail!("usage: cargo xtask bench [FILTER] [--peers] [--data DIR]"),
        }
    }
    Ok(options)
}

/// Runs one job and prints its other output.
fn measure(mut job: jobs::Job) -> Result<Vec<Measurement>, (String, anyhow::Error)> {
    // One thread everywhere, or the comparison is of thread counts.
    for variable in ["OPENBLAS_NUM_THREADS", "OMP_NUM_THREADS", "RAYON_NUM_THREADS"] {
        job.command.env(variable, "1");
    }
    let text =
        shell::output(job.command.stdout(Stdio::piped())).map_err(|error| (job.name.clone(), error))?;
    let mut measured = Vec::new();
    for line in text.lines() {
        match (job.read)(line) {
            Some(measurement) => measured.push(measurement),
            None if !line.trim().is_empty() => println!("    {line}"),
            None => {}
        }
    }
    if measured.is_empty() {
        return Err((job.name, anyhow::anyhow!("it printed no measurement")));
    }
    Ok(measured)
}
