//! Running programs, and where things are.

use std::ffi::OsStr;
use std::fmt::Write as _;
use std::path::{Path, PathBuf};
use std::process::{Command, ExitCode, Stdio};

use anyhow::{Context, Result, bail};

/// The folder that holds the workspace's `Cargo.toml`.
pub(crate) fn root() -> &'static Path {
    Path::new(env!("CARGO_MANIFEST_DIR")).parent().unwrap_or(Path::new("."))
}

/// The target directory of cargo.
pub(crate) fn target_dir() -> PathBuf {
    match std::env::var_os("CARGO_TARGET_DIR") {
        Some(dir) => root().join(dir),
        None => root().join("target"),
    }
}

/// `program` with `args`, to be run in the root of the workspace.
pub(crate) fn command(program: impl AsRef<OsStr>, args: &[&str]) -> Command {
    let mut command = Command::new(program);
    command.args(args).current_dir(root()).stdin(Stdio::null());
    command
}

/// The command line; arguments follow.
pub(crate) fn wayfix(args: &[&str]) -> Command {
    program("wayfix", args)
}

/// The experiments; arguments follow.
pub(crate) fn experiments(args: &[&str]) -> Command {
    program("wayfix-experiments", args)
}

/// The profile is that of the tests, which optimizes too: a release build takes longer than what it saves here.
fn program(name: &str, args: &[&str]) -> Command {
    let mut command = cargo("run", name);
    command.arg("--").args(args);
    command
}

/// The command that builds `wayfix` or `wayfix-experiments`.
pub(crate) fn build(program: &str) -> Command {
    cargo("build", program)
}

/// Environment variable with features for [`program`] and [`build`]: those of the tests, so that CI compiles each crate once.
pub(crate) const FEATURES: &str = "XTASK_FEATURES";

/// Without [`FEATURES`] cargo builds the package of the program alone; with them, with the features of the whole workspace, as the tests do.
fn cargo(verb: &str, program: &str) -> Command {
    let mut command = command("cargo", &[verb, "--quiet", "--locked", "--bin", program]);
    match std::env::var(FEATURES) {
        Ok(features) => command.args(["--features", &features]),
        Err(_) => command.args(["--package", program]),
    };
    command
}

/// Whether `program --version` can be run.
pub(crate) fn have(program: impl AsRef<OsStr>) -> bool {
    let mut probe = command(program, &["--version"]);
    probe.stdout(Stdio::null()).stderr(Stdio::null()).status().is_ok_and(|status| status.success())
}

/// A tool of the Python environment that `.ci/run` makes, else the one on the path.
pub(crate) fn python_tool(name: &str) -> PathBuf {
    let ours = target_dir().join("venv/bin").join(name);
    if ours.exists() { ours } else { PathBuf::from(name) }
}

/// Whether this Python finds all of `modules`.
pub(crate) fn python_has(modules: &[&str]) -> bool {
    let script = format!("import {}", modules.join(", "));
    let mut probe = command(python_tool("python3"), &["-c", &script]);
    probe.stdout(Stdio::null()).stderr(Stdio::null()).status().is_ok_and(|status| status.success())
}

/// Whether a program is available; a missing one is an error if CI requires it.
pub(crate) fn available(what: &str, found: bool, remedy: &str) -> Result<bool> {
    let required = std::env::var("CI").is_ok_and(|value| value == "true");
    if !found && required {
        bail!("{what} is missing, and CI=true requires it ({remedy})");
    }
    if !found {
        println!("{what} is missing, check skipped ({remedy})");
    }
    Ok(found)
}

/// Runs a command; returns an error if it fails.
pub(crate) fn check(command: &mut Command) -> Result<()> {
    let status = command.status().with_context(|| format!("cannot start `{}`", spelled(command)))?;
    if !status.success() {
        bail!("`{}` failed ({status})", spelled(command));
    }
    Ok(())
}

/// Runs to the end and hands the program's exit code on.
pub(crate) fn pass_on(command: &mut Command) -> Result<ExitCode> {
    let status = command.status().with_context(|| format!("cannot start `{}`", spelled(command)))?;
    Ok(status.code().and_then(|code| u8::try_from(code).ok()).map_or(ExitCode::FAILURE, ExitCode::from))
}

/// Runs a command and returns standard output; standard error goes to the terminal.
pub(crate) fn output(command: &mut Command) -> Result<String> {
    let output = command
        .stderr(Stdio::inherit())
        .output()
        .with_context(|| format!("cannot start `{}`", spelled(command)))?;
    if !output.status.success() {
        bail!("`{}` failed ({})", spelled(command), output.status);
    }
    String::from_utf8(output.stdout).with_context(|| format!("output of `{}`", spelled(command)))
}

/// The command as typed in a shell.
pub(crate) fn spelled(command: &Command) -> String {
    let mut line = String::new();
    for (key, value) in command.get_envs() {
        if let Some(value) = value {
            let _ = write!(line, "{}={:?} ", key.display(), value.display().to_string());
        }
    }
    line.push_str(&command.get_program().to_string_lossy());
    for arg in command.get_args() {
        let arg = arg.to_string_lossy();
        let plain = !arg.is_empty() && !arg.contains(|c: char| c.is_whitespace() || "\"'$&|;()".contains(c));
        let _ = if plain { write!(line, " {arg}") } else { write!(line, " '{arg}'") };
    }
    line
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_command_is_spelled_so_that_it_can_be_repeated() {
        let mut doc = command("cargo", &["doc", "--html-in-header", "a file.html"]);
        doc.env("RUSTDOCFLAGS", "-D warnings");
        assert_eq!(spelled(&doc), "RUSTDOCFLAGS=\"-D warnings\" cargo doc --html-in-header 'a file.html'");
    }

    #[test]
    fn a_failing_program_is_an_error_that_names_it() {
        let error = check(&mut command("sh", &["-c", "exit 3"])).unwrap_err();
        assert!(error.to_string().contains("exit 3"), "{error}");
        assert!(check(&mut command("no-such-program-here", &[])).is_err());
    }
}
