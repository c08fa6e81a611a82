//! `cargo xtask examples`: runs every example that takes no arguments, as its first comment says.

use std::fs;
use std::process::ExitCode;

use anyhow::{Context, Result, bail};
use serde_json::Value;

use crate::shell;

pub(crate) fn run(args: &[String]) -> Result<ExitCode> {
    let mut build = shell::command("cargo", &["build", "--quiet", "--locked", "--workspace", "--examples"]);
    if let Ok(features) = std::env::var(shell::FEATURES) {
        build.args(["--features", &features]); // as the tests, which have built them
    }
    shell::check(&mut build)?;
    let programs = shell::target_dir().join("debug/examples");
    let metadata = shell::command("cargo", &["metadata", "--no-deps", "--format-version", "1"]).output()?;
    let metadata: Value = serde_json::from_slice(&metadata.stdout).context("cargo metadata")?;
    let mut unknown: Vec<&String> = args.iter().collect();
    let mut n_run = 0;
    for package in metadata["packages"].as_array().into_iter().flatten() {
        for target in package["targets"].as_array().into_iter().flatten() {
            let is_example = target["kind"].as_array().is_some_and(|kinds| kinds.contains(&"example".into()));
            let (package, name) = (text(&package["name"]), text(&target["name"]));
            if !is_example || !(args.is_empty() || args.iter().any(|arg| arg == name)) {
                continue;
            }
            unknown.retain(|arg| *arg != name);
            let source = fs::read_to_string(text(&target["src_path"]))?;
            let Some(command) = command(&source) else {
                bail!("example {name} of {package} does not say how to run it")
            };
            if takes_no_argument(command) {
                println!("examples: {name}");
                let mut command = shell::command(programs.join(name), &[]);
                shell::check(&mut command).with_context(|| format!("example {name} of {package}"))?;
                n_run += 1;
            } else if !args.is_empty() {
                bail!("example {name} takes arguments: {command}");
            }
        }
    }
    if !unknown.is_empty() {
        bail!("no example {unknown:?}\nusage: cargo xtask examples [NAME…]");
    }
    println!("examples: {n_run} run");
    Ok(ExitCode::SUCCESS)
}

fn text(value: &Value) -> &str {
    value.as_str().unwrap_or_default()
}

/// The command in the first comment that runs the example.
fn command(source: &str) -> Option<&str> {
    let comment = source.lines().take_while(|line| line.starts_with("//!"));
    comment
        .flat_map(|line| line.split('`'))
        .find(|code| code.contains("cargo run") && code.contains("--example"))
}

fn takes_no_argument(command: &str) -> bool {
    command.split_once("--example ").is_some_and(|(_, name)| !name.trim().contains(' '))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_command_with_arguments_is_not_run() {
        let source = "//! Text `code`.\n//! `cargo run -p wayfix-kalman --example 01_line`\n\nfn main() {}";
        let found = command(source).unwrap();
        assert_eq!(found, "cargo run -p wayfix-kalman --example 01_line");
        assert!(takes_no_argument(found));
        assert!(!takes_no_argument("cargo run -p wayfix-kalman --example 01_line -- PATH"));
        assert!(!takes_no_argument("cargo run -p wayfix-kalman --example 01_line [SEED]"));
        assert_eq!(command("fn main() {}"), None);
    }
}
