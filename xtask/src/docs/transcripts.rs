//! `cargo xtask docs --transcripts`: recordings of a terminal in the pages of `docs`, written by running their commands.

use std::env;
use std::fmt::Write as _;
use std::iter::once;
use std::process::ExitCode;

use anyhow::{Context, Result, bail};

use super::figures;
use crate::shell;

/// Start marker of a recording; its commands follow in a fence, each after a prompt.
const BEGIN: &str = "<!-- transcript -->\n";
const END: &str = "<!-- end transcript -->";
const FENCE: &str = "```text\n";
const PROMPT: &str = "$ ";
/// Lines of an output that are shown at its beginning and at its end.
const HEAD: usize = 4;
const TAIL: usize = 9;

pub(super) fn run(args: &[String]) -> Result<ExitCode> {
    if !args.is_empty() {
        bail!("usage: cargo xtask docs --transcripts");
    }
    shell::check(&mut shell::build("wayfix"))?;
    for page in figures::pages(&shell::root().join("docs"))? {
        let text = std::fs::read_to_string(&page)?;
        let written = rewritten(&text, &output_of).with_context(|| page.display().to_string())?;
        if written != text {
            std::fs::write(&page, written)?;
            println!("docs: recordings of {}", page.display());
        }
    }
    Ok(ExitCode::SUCCESS)
}

/// The page with the output of each command after it.
fn rewritten(page: &str, output_of: &dyn Fn(&str) -> Result<String>) -> Result<String> {
    let mut parts = page.split(BEGIN);
    let mut written = parts.next().unwrap_or_default().to_owned();
    for part in parts {
        let (old, after) = part.split_once(END).context("a recording has no end")?;
        let mut recording = String::new();
        for command in old.lines().filter_map(|line| line.strip_prefix(PROMPT)) {
            let _ = writeln!(recording, "{PROMPT}{command}\n{}", shortened(&output_of(command)?));
        }
        let _ = write!(written, "{BEGIN}{FENCE}{recording}```\n{END}{after}");
    }
    Ok(written)
}

/// What a command prints for people, in the root of the workspace; the target directory has its usual name.
fn output_of(command: &str) -> Result<String> {
    let programs = shell::target_dir().join("debug");
    let path = env::var_os("PATH").unwrap_or_default();
    let path = env::join_paths(once(programs).chain(env::split_paths(&path)))?;
    let mut shell = shell::command("sh", &["-c", &format!("{command} 2>&1")]);
    let printed = shell::output(shell.env("PATH", path))?;
    Ok(printed.replace(&shell::target_dir().display().to_string(), "target"))
}

/// Beginning and end of a long output.
fn shortened(output: &str) -> String {
    let lines: Vec<&str> = output.lines().map(str::trim_end).collect();
    let n_left_out = lines.len().saturating_sub(HEAD + TAIL);
    if n_left_out < 2 {
        return lines.join("\n");
    }
    let left_out = format!("… {n_left_out} more lines");
    let (head, tail) = (&lines[..HEAD], &lines[lines.len() - TAIL..]);
    [head, &[left_out.as_str()], tail].concat().join("\n")
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_recording_is_written_again_and_the_rest_of_the_page_kept() {
        let page =
            "# A\n<!-- transcript -->\n```text\n$ one\nold\n$ two\n```\n<!-- end transcript -->\nafter\n";
        let written = rewritten(page, &|command| Ok(format!("{command}!\n"))).unwrap();
        let expected = "# A\n<!-- transcript -->\n```text\n$ one\none!\n$ two\ntwo!\n```\n<!-- end transcript -->\nafter\n";
        assert_eq!(written, expected);
        assert!(rewritten(BEGIN, &|_| Ok(String::new())).is_err());
    }

    #[test]
    fn a_long_output_keeps_its_beginning_and_its_end() {
        let lines: Vec<String> = (0..30).map(|line| line.to_string()).collect();
        let short = shortened(&lines.join("\n"));
        assert!(short.starts_with("0\n1\n2\n3\n… 17 more lines\n21\n") && short.ends_with("\n29"), "{short}");
        assert_eq!(shortened("a\nb\n"), "a\nb");
    }
}
