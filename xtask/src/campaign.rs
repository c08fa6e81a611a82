//! `cargo xtask campaign`: runs the recipe for GNU parallel in `docs/campaigns` as documented.

use std::process::ExitCode;

use anyhow::{Result, bail, ensure};

use crate::shell::{self, available};

pub(crate) fn run(args: &[String]) -> Result<ExitCode> {
    ensure!(args.is_empty(), "usage: cargo xtask campaign");
    if !available("GNU parallel", shell::have("parallel"), ".ci/run, or apt-get install parallel")? {
        return Ok(ExitCode::SUCCESS);
    }
    shell::check(&mut shell::build("wayfix-experiments"))?;
    let out = shell::target_dir().join("campaign");
    if out.exists() {
        std::fs::remove_dir_all(&out)?; // shares of an older campaign do not belong to this one
    }
    let mut recipe = shell::command(shell::root().join("docs/campaigns/parallel.sh"), &["3"]);
    recipe.arg(&out).args(["lines", "--quick", "--seeds", "2"]);
    recipe.env("WAYFIX", shell::target_dir().join("debug/wayfix-experiments"));
    shell::check(&mut recipe)?;
    if !out.join("index.html").is_file() {
        bail!("no report in {}", out.display());
    }
    Ok(ExitCode::SUCCESS)
}
