use std::process::ExitCode;

use anyhow::Result;
use clap::CommandFactory;
use clap_complete::{Shell, generate};

use wayfix_evaluation::terminal::print;

/// Print the script that completes `wayfix` in a shell.
#[derive(clap::Args)]
#[command(after_long_help = EXAMPLES)]
pub(in crate::cli) struct Arguments {
    /// The shell.
    shell: Shell,
}

const EXAMPLES: &str = "\
Examples:
  wayfix completions bash > ~/.local/share/bash-completion/completions/wayfix
  wayfix completions zsh > ~/.zfunc/_wayfix
  wayfix completions fish > ~/.config/fish/completions/wayfix.fish";

pub(in crate::cli) fn main(arguments: Arguments) -> Result<ExitCode> {
    let mut script = Vec::new();
    generate(arguments.shell, &mut super::super::Arguments::command(), "wayfix", &mut script);
    print(String::from_utf8_lossy(&script))?;
    Ok(ExitCode::SUCCESS)
}
