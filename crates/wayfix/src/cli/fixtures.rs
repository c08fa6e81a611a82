use std::{path::PathBuf, process::ExitCode};

use anyhow::Result;

use super::output::print;
use crate::fixtures;

#[derive(clap::Subcommand)]
pub(super) enum Command {
    /// Write every stored log from its seed.
    Build(Arguments),
    /// Compare every stored log with what its seed gives, byte for byte.
    Check(Arguments),
}

#[derive(clap::Args)]
pub(super) struct Arguments {
    /// Folder of the stored logs.
    #[arg(default_value = "fixtures")]
    folder: PathBuf,
}

pub(super) fn main(command: Command) -> Result<ExitCode> {
    let (stored, verb) = match &command {
        Command::Build(arguments) => (fixtures::build(&arguments.folder)?, "wrote"),
        Command::Check(arguments) => (fixtures::check(&arguments.folder)?, "same"),
    };
    for log in stored {
        print(format!("{verb} {} ({} bytes)\n", log.path.display(), log.n_bytes))?;
    }
    Ok(ExitCode::SUCCESS)
}
