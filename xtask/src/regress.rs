//! `cargo xtask regress`: the regression run of `wayfix-experiments`, with the folder for results filled in.

use std::path::{Path, PathBuf};
use std::process::ExitCode;

use anyhow::Result;

use crate::shell;

pub(crate) fn run(args: &[String]) -> Result<ExitCode> {
    let mut command = shell::experiments(&["regress"]);
    command.args(args);
    if !names_option(args, "--out") {
        command.arg("--out").arg(default_out());
    }
    shell::pass_on(&mut command)
}

/// Default folder of reports, without `--out`.
pub(crate) fn default_out() -> PathBuf {
    let out = shell::target_dir().join("regress");
    out.strip_prefix(shell::root()).map(Path::to_path_buf).unwrap_or(out)
}

fn names_option(args: &[String], option: &str) -> bool {
    args.iter().any(|arg| arg == option || arg.strip_prefix(option).is_some_and(|rest| rest.starts_with('=')))
}

#[cfg(test)]
mod tests {
    use super::names_option;

    #[test]
    fn an_option_is_found_in_both_spellings() {
        let args = |list: &[&str]| list.iter().map(|arg| (*arg).to_owned()).collect::<Vec<_>>();
        assert!(names_option(&args(&["slam", "--out", "x"]), "--out"));
        assert!(names_option(&args(&["--out=x"]), "--out"));
        assert!(!names_option(&args(&["--outer", "out"]), "--out"));
    }
}
