//! `cargo xtask ci`: every check, the ones that fail early and cheaply first.
//!
//! Every step uses the dev profile, which optimizes, so each dependency is compiled once and checked once.

use std::process::{Command, ExitCode};
use std::time::{Duration, Instant};

use anyhow::{Context, Result, bail};

use crate::shell;

struct Step {
    name: &'static str,
    command: Command,
}

pub(crate) fn run(args: &[String]) -> Result<ExitCode> {
    let mut steps = steps()?;
    match args {
        [] => {}
        [flag, first] if flag == "--from" => {
            let names: Vec<_> = steps.iter().map(|step| step.name).collect();
            let position = names.iter().position(|name| name == first);
            steps
                .drain(..position.with_context(|| format!("no step `{first}`; steps: {}", names.join(" ")))?);
        }
        _ => bail!("usage: cargo xtask ci [--from STEP]"),
    }
    let mut times = Vec::new();
    for step in &mut steps {
        println!("\n── {}: {}", step.name, shell::spelled(&step.command));
        let (outcome, time) = timed(|| shell::check(&mut step.command));
        times.push((step.name, time, outcome.is_ok()));
        if let Err(error) = outcome {
            print!("{}", table(&times));
            println!("\n{error:#}\nrepeat it with\n    {}", shell::spelled(&step.command));
            println!("and go on with\n    cargo xtask ci --from {}", step.name);
            return Ok(ExitCode::FAILURE);
        }
    }
    print!("{}", table(&times));
    Ok(ExitCode::SUCCESS)
}

/// Features that are off by default are checked too.
const LIVE: &str = "--features=wayfix/live";

fn steps() -> Result<Vec<Step>> {
    let step = |name, args: &[&str]| Step { name, command: shell::command("cargo", args) };
    let itself = std::env::current_exe().context("where this program is")?;
    // Runs the program itself, because `cargo xtask` would rebuild it while it runs.
    let task = |name, args: &[&str]| {
        let mut command = shell::command(&itself, args);
        command.env(shell::FEATURES, "wayfix/live");
        Step { name, command }
    };

    let tests = if shell::have("cargo-nextest") {
        step("tests", &["nextest", "run", "--workspace", LIVE, "--locked", "--no-tests", "pass"])
    } else {
        step("tests", &["test", "--workspace", LIVE, "--locked", "--lib", "--bins", "--tests", "--examples"])
    };
    // The stored logs are checked by a test of wayfix-experiments.
    Ok(vec![
        step("fmt", &["fmt", "--all", "--check"]),
        task("tidy", &["tidy"]),
        task("spelling", &["spelling"]),
        task("licenses", &["licenses"]),
        step("clippy", &["clippy", "--workspace", "--all-targets", LIVE, "--locked", "--", "-D", "warnings"]),
        // As `cargo xtask regress` builds it for users: without the features of other packages.
        step("default-run", &["check", "--package", "wayfix-experiments", "--locked"]),
        tests,
        step("doctests", &["test", "--workspace", LIVE, "--doc", "--locked"]),
        task("docs", &["docs"]),
        task("regress", &["regress"]),
        task("clients", &["clients"]),
        task("examples", &["examples"]),
        task("tutorials", &["tutorials"]),
        task("campaign", &["campaign"]),
        task("robot", &["robot"]),
    ])
}

#[expect(
    clippy::disallowed_methods,
    reason = "how long a step took is for people; nothing is computed from it"
)]
fn timed<T>(work: impl FnOnce() -> T) -> (T, Duration) {
    let start = Instant::now();
    let result = work();
    (result, start.elapsed())
}

fn table(times: &[(&str, Duration, bool)]) -> String {
    let mut text = String::from("\nstep          time\n");
    for (name, time, passed) in times {
        let verdict = if *passed { "ok" } else { "FAILED" };
        text += &format!("{name:<10} {:>6.1} s  {verdict}\n", time.as_secs_f64());
    }
    let total: Duration = times.iter().map(|(_, time, _)| *time).sum();
    text + &format!("{:<10} {:>6.1} s\n", "total", total.as_secs_f64())
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_table_has_every_step_the_verdict_and_the_sum() {
        let text =
            table(&[("fmt", Duration::from_millis(500), true), ("tidy", Duration::from_secs(2), false)]);
        assert!(text.contains("fmt           0.5 s  ok\n"), "{text}");
        assert!(text.contains("tidy          2.0 s  FAILED\n"), "{text}");
        assert!(text.ends_with("total         2.5 s\n"), "{text}");
    }

    #[test]
    fn an_unknown_step_is_refused_with_the_list_of_steps() {
        let error = run(&["--from".into(), "lunch".into()]).unwrap_err();
        assert!(error.to_string().contains("fmt tidy spelling licenses clippy default-run tests"), "{error}");
    }
}
