//! `cargo xtask robot`: builds and runs robots outside the workspace, as their developers do.

use std::process::ExitCode;

use anyhow::{Result, ensure};

use crate::shell;

pub(crate) fn run(args: &[String]) -> Result<ExitCode> {
    ensure!(args.is_empty(), "usage: cargo xtask robot");
    for entry in std::fs::read_dir(shell::root().join("robots"))? {
        let manifest = entry?.path().join("Cargo.toml");
        let mut command = shell::command("cargo", &["run", "--locked", "--manifest-path"]);
        shell::check(command.arg(manifest).arg("--target-dir").arg(shell::target_dir().join("robots")))?;
    }
    Ok(ExitCode::SUCCESS)
}
