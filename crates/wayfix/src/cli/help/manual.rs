use std::{path::PathBuf, process::ExitCode};

use anyhow::{Context, Result};
use clap::CommandFactory;

use wayfix_evaluation::terminal::print;

/// Write the manual pages, wayfix.1 and one for each command, to a folder.
#[derive(clap::Args)]
#[command(after_long_help = EXAMPLES)]
pub(in crate::cli) struct Arguments {
    /// The folder; it is created if missing.
    folder: PathBuf,
}

const EXAMPLES: &str = "\
Examples:
  wayfix manual ~/.local/share/man/man1       then: man wayfix-run-slam";

pub(in crate::cli) fn main(arguments: Arguments) -> Result<ExitCode> {
    let folder = arguments.folder;
    let failed = || format!("cannot write manual pages to {}", folder.display());
    std::fs::create_dir_all(&folder).with_context(failed)?;
    clap_mangen::generate_to(super::super::Arguments::command(), &folder).with_context(failed)?;
    print(format!("manual pages in {}\n", folder.display()))?;
    Ok(ExitCode::SUCCESS)
}
