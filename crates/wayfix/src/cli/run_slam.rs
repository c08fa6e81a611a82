use std::{
    fs,
    path::{Path, PathBuf},
    process::ExitCode,
};

use anyhow::{Context, Result};
use wayfix_sensor_log::{Format, LogMeta, OpenOptions};

use super::{input::read_toml, progress};
use crate::{
    report::{Machine, Report, Run, RunSummary, Suite, table, table::TableStyle},
    slam::{self, AssociationRule, EstimateLog, Profile, SlamSystemParams},
    system::Stopwatch,
};

/// EKF-SLAM on a log with odometry and range-bearing sightings of landmarks.
#[derive(clap::Args)]
pub(super) struct Arguments {
    /// The log: an MCAP file, a folder of the UTIAS set, a text file of range-bearing lines.
    #[arg(long)]
    log: PathBuf,
    /// How the log is stored: utias, range-bearing, mcap. Detected when not given.
    #[arg(long)]
    format: Option<Format>,
    /// Which robot, in sets of several.
    #[arg(long)]
    robot: Option<u32>,
    /// How sightings find their landmarks: by identity, or nearest neighbour with two thresholds. By default by identity where the
    /// log has identities.
    #[arg(long)]
    association: Option<AssociationRule>,
    /// Defaults of a kind of robot. By default what the format of the log tells, else generic.
    #[arg(long)]
    profile: Option<Profile>,
    /// Parameters in a TOML file; those it does not name keep the defaults of the profile.
    #[arg(long)]
    params: Option<PathBuf>,
    /// Folder for index.html, report.json, the figures as SVG and the estimates as MCAP. Nothing is written without it.
    #[arg(long)]
    out: Option<PathBuf>,
    /// Print one JSON object instead of a table.
    #[arg(long)]
    json: bool,
    /// Seed of every generator. EKF-SLAM draws nothing; the seed is passed on to the output.
    #[arg(long, default_value_t = 1)]
    seed: u64,
}

pub(super) fn main(arguments: Arguments) -> Result<ExitCode> {
    let options = OpenOptions { format: arguments.format, robot: arguments.robot, ..OpenOptions::default() };
    let log = wayfix_sensor_log::open(&arguments.log, &options)?;
    let params = params(&arguments, log.meta())?;
    let (records, read) = log.read_all();
    if read.n_problems() > 0 {
        eprintln!("{read}");
    }

    let stopwatch = Stopwatch::start();
    let mut estimates = arguments.out.as_deref().map(open_estimates).transpose()?;
    let bar = progress::bar(records.len(), "EKF-SLAM");
    let mut index = 0;
    let mut slam = slam::run(&records, &params, |system| {
        if let Some(estimates) = &mut estimates {
            estimates.observe(&records[index], system);
        }
        index += 1;
        bar.inc(1);
    })?;
    bar.finish_and_clear();
    for refusal in slam.events().refusals() {
        eprintln!("refused {refusal}");
    }
    slam.events().add("log_problem", read.n_problems());

    let mut run = Run {
        name: arguments.log.display().to_string(),
        seconds: stopwatch.elapsed().as_secs_f64(),
        ..slam::summarize(&mut slam)
    };
    if arguments.json {
        println!("{}", serde_json::to_string(&RunSummary::new(&run, arguments.seed))?);
    } else {
        print!("{}", table::run(&run, TableStyle::of_stdout()));
    }
    if let (Some(out), Some(estimates)) = (&arguments.out, estimates) {
        estimates.finish()?;
        run.log = Some(ESTIMATES.to_owned());
        run.figures = slam::pictures(&slam)?;
        write_report(out, run, arguments.seed)?;
    }
    Ok(ExitCode::SUCCESS)
}

const ESTIMATES: &str = "estimates.mcap";

fn params(arguments: &Arguments, meta: &LogMeta) -> Result<SlamSystemParams> {
    let profile = arguments.profile.unwrap_or(Profile::of_log(meta));
    let mut params = match &arguments.params {
        Some(path) => read_toml(path, |text| SlamSystemParams::from_toml(text, profile))?,
        None => SlamSystemParams::of(profile),
    };
    params.association = arguments.association.or(params.association);
    Ok(params)
}

fn open_estimates(out: &Path) -> Result<EstimateLog> {
    fs::create_dir_all(out).with_context(|| format!("cannot create {}", out.display()))?;
    Ok(EstimateLog::create(&out.join(ESTIMATES))?)
}

fn write_report(out: &Path, run: Run, seed: u64) -> Result<()> {
    for (number, figure) in run.figures.iter().enumerate() {
        let path = out.join(format!("figure-{}.svg", number + 1));
        fs::write(&path, figure.standalone()).with_context(|| format!("cannot write {}", path.display()))?;
    }
    let suites = vec![Suite { name: "slam".to_owned(), runs: vec![run] }];
    Report { suites, seed, commit: None, machine: Machine::detect() }.write(out)?;
    eprintln!("wrote index.html, report.json, {ESTIMATES} and the figures as SVG to {}", out.display());
    Ok(())
}
