//! The command line: regress, the stored logs, reports of several machines.

mod fixtures;
mod merge_reports;
mod regress;
mod session;

use std::process::ExitCode;

use clap::{CommandFactory, Parser, Subcommand};
use wayfix_evaluation::terminal::print_message;

/// The experiments of Wayfix: every system on stored logs and public recordings, compared with the figures of papers and other programs.
///
/// Examples:
///   wayfix-experiments regress                    every system on the stored logs
///   wayfix-experiments regress slam --data DATA   one suite, on public recordings too
///   wayfix-experiments fixtures check fixtures    are the stored logs what their seeds make?
#[derive(Parser)]
#[command(name = "wayfix-experiments", version, verbatim_doc_comment)]
struct Arguments {
    #[command(subcommand)]
    command: Command,
}

/// The doc comment of an argument structure is its help; the group has it here.
#[derive(Subcommand)]
enum Command {
    Regress(regress::Arguments),
    MergeReports(merge_reports::Arguments),
    /// Build or check the stored logs.
    #[command(subcommand)]
    Fixtures(fixtures::Command),
}

/// Whether the program accepts a command line, which begins with its name. For tests of the documentation.
/// # Errors
/// Returns the error message of `clap` if the command line is invalid.
#[doc(hidden)]
pub fn parses<T: Into<std::ffi::OsString> + Clone>(
    command_line: impl IntoIterator<Item = T>,
) -> Result<(), clap::Error> {
    Arguments::try_parse_from(command_line).map(|_| ())
}

/// The commands and their options as `clap` defines them. For tests of the documentation.
#[doc(hidden)]
pub fn commands() -> clap::Command {
    Arguments::command()
}

/// Parses and executes the command line, and prints errors to standard error. Returns 0, 1 (failure) or 2 (wrong usage).
pub fn main() -> ExitCode {
    let result = match Arguments::parse().command {
        Command::Regress(arguments) => regress::main(arguments),
        Command::MergeReports(arguments) => merge_reports::main(arguments),
        Command::Fixtures(command) => fixtures::main(command),
    };
    result.unwrap_or_else(|error| {
        print_message(format!("error: {error:#}"));
        ExitCode::FAILURE
    })
}
