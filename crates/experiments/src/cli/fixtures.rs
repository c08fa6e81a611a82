use std::{fs, path::PathBuf, process::ExitCode};

use anyhow::{Context, Result};
use wayfix_evaluation::terminal::print;

use crate::{
    color::{TrainingHalls, learn_broad_priors},
    fixtures,
};

#[derive(clap::Subcommand)]
pub(super) enum Command {
    /// Write every stored log from its seed.
    Build(Arguments),
    /// Compare every stored log with the output of its seed, byte for byte.
    Check(Arguments),
    /// Learn the priors of `wayfix run color` from the simulated training venues.
    Priors {
        /// Output file.
        #[arg(default_value = "crates/systems/data/four-legged-priors.json")]
        file: PathBuf,
        /// Number of kinds of light, from dark to bright.
        #[arg(long, default_value_t = 2)]
        lights: usize,
        /// Learn broad priors for any lamp and any camera, instead of those of the simulated halls.
        #[arg(long)]
        broad: bool,
    },
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
        Command::Priors { file, lights, broad } => {
            let learned = match broad {
                true => learn_broad_priors(*lights)?,
                false => TrainingHalls::default().learn_priors(*lights)?,
            };
            let text = serde_json::to_string(&learned)? + "\n";
            fs::write(file, text).with_context(|| format!("cannot write {}", file.display()))?;
            return Ok(ExitCode::SUCCESS);
        }
    };
    for log in stored {
        print(format!("{verb} {} ({} bytes)\n", log.path.display(), log.n_bytes))?;
    }
    Ok(ExitCode::SUCCESS)
}
