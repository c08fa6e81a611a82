//! `cargo xtask spelling`: checks the spelling; `typos.toml` lists the technical terms.

use std::process::ExitCode;

use anyhow::{Result, ensure};

use crate::shell::{self, available};

pub(crate) fn run(args: &[String]) -> Result<ExitCode> {
    ensure!(args.is_empty(), "usage: cargo xtask spelling");
    let typos = shell::python_tool("typos");
    if available("a spelling checker", shell::have(&typos), ".ci/run, or pip install typos")? {
        shell::check(&mut shell::command(&typos, &["--format", "brief"]))?;
    }
    Ok(ExitCode::SUCCESS)
}
