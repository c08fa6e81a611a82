//! The command line: one command a file.

mod common;
mod compare;
mod convert;
mod help;
mod info;
mod input;
mod learn_priors;
#[cfg_attr(not(feature = "live"), path = "no_live.rs")]
mod live;
mod optimize;
mod outputs;
mod parameter_file;
mod params;
mod read_problems;
mod run;
mod simulate;
mod truth;

use std::process::ExitCode;

use anyhow::Result;
use clap::{CommandFactory, Parser, Subcommand};

/// Probabilistic robot localization on your logs.
///
/// Examples:
///   wayfix info slam_100.txt                      content of a log
///   wayfix run slam --log slam_100.txt            trajectory and map, with figures where the log has truth
///   wayfix run slam --log MRCLAM_Dataset7 --robot 1 --out results
///   wayfix run lines --log intel.log.gz           walls in laser scans
///   wayfix run color --log color_dark.mcap --map four-legged-field.toml
///   wayfix run views --scene china.jpg             the view of a camera in a known scene, in other light
///   wayfix run track --frames David/img --init 129,80,64,78
///                                                 a target in every image, from its box in the first
///   wayfix run cml --frames route --poses poses.csv  pose of a robot from panoramic images
///   wayfix convert slam_100.txt slam_100.mcap      for Foxglove and Rerun
///   wayfix optimize manhattan.g2o.gz              the best poses of a pose graph
///   wayfix learn-priors --images DIR --labels DIR --out priors.json
///                                                 colours from labelled images, for run color
///   wayfix compare results other-results           figures of two reports side by side
#[derive(Parser)]
#[command(name = "wayfix", version, verbatim_doc_comment)]
struct Arguments {
    #[command(subcommand)]
    command: Command,
}

/// The doc comment of an argument structure is its help; groups have it here.
#[derive(Subcommand)]
enum Command {
    /// Run a system on a log.
    #[command(subcommand)]
    Run(Box<Run>),
    Params(params::Arguments),
    Info(info::Arguments),
    Convert(convert::Arguments),
    Optimize(optimize::Arguments),
    LearnPriors(learn_priors::Arguments),
    Compare(compare::Arguments),
    Doctor(help::doctor::Arguments),
    Completions(help::completions::Arguments),
    Manual(help::manual::Arguments),
    /// Make simulated images to try a system on.
    #[command(subcommand)]
    Simulate(simulate::Command),
}

#[derive(Subcommand)]
enum Run {
    Slam(run::run_slam::Arguments),
    Lines(run::run_lines::Arguments),
    Color(run::run_color::Arguments),
    Views(run::run_views::Arguments),
    Track(run::run_track::Arguments),
    Cml(Box<run::run_cml::Arguments>),
}

/// Whether the program accepts a command line, which begins with its name. For tests of the documentation.
/// # Errors
/// Returns the error message of `clap` if the command line is invalid.
#[doc(hidden)]
pub fn parses<T: Into<std::ffi::OsString> + Clone>(
    command_line: impl IntoIterator<Item = T>,
) -> Result<(), clap::Error> {
    Arguments::command().try_get_matches_from(command_line).map(|_| ())
}

/// The commands and their options as `clap` defines them. For tests of the documentation.
#[doc(hidden)]
pub fn commands() -> clap::Command {
    Arguments::command()
}

/// Parses and executes the command line, and prints errors to standard error. Returns 0, 1 (failure) or 2 (wrong usage).
pub fn main() -> ExitCode {
    let result = match Arguments::parse().command {
        Command::Run(system) => run(*system),
        Command::Params(arguments) => params::main(arguments),
        Command::Info(arguments) => info::main(arguments),
        Command::Convert(arguments) => convert::main(arguments),
        Command::Optimize(arguments) => optimize::main(arguments),
        Command::LearnPriors(arguments) => learn_priors::main(arguments),
        Command::Compare(arguments) => compare::main(arguments),
        Command::Doctor(arguments) => help::doctor::main(&arguments),
        Command::Completions(arguments) => help::completions::main(arguments),
        Command::Manual(arguments) => help::manual::main(arguments),
        Command::Simulate(command) => simulate::main(command),
    };
    match result {
        Ok(code) => code,
        Err(error) => {
            wayfix_evaluation::terminal::print_message(format!("error: {}", with_causes(&error)));
            ExitCode::FAILURE
        }
    }
}

/// An error with its causes; causes that its text already ends with are not repeated.
fn with_causes(error: &anyhow::Error) -> String {
    error.chain().skip(1).fold(error.to_string(), |text, cause| {
        let cause = cause.to_string();
        if text.ends_with(&cause) { text } else { format!("{text}: {cause}") }
    })
}

fn run(system: Run) -> Result<ExitCode> {
    run::interrupt::listen()?;
    let code = match system {
        Run::Slam(arguments) => run::run_slam::main(arguments),
        Run::Lines(arguments) => run::run_lines::main(arguments),
        Run::Color(arguments) => run::run_color::main(arguments),
        Run::Views(arguments) => run::run_views::main(arguments),
        Run::Track(arguments) => run::run_track::main(arguments),
        Run::Cml(arguments) => run::run_cml::main(*arguments),
    };
    code.map(run::interrupt::exit_code)
}
