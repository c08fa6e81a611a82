//! `cargo xtask fixtures`: the stored logs, rebuilt from their seeds or compared byte for byte.

use std::process::ExitCode;

use anyhow::{Result, bail};

use crate::shell;

pub(crate) fn run(args: &[String]) -> Result<ExitCode> {
    let verb = match args {
        [] => "build",
        [flag] if flag == "--check" => "check",
        _ => bail!("usage: cargo xtask fixtures [--check]"),
    };
    shell::pass_on(&mut shell::experiments(&["fixtures", verb]))
}
