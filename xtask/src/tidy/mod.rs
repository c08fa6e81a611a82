//! `cargo xtask tidy`: the invariants of `docs/architecture.md` that a machine can check.
//!
//! Every check is a function from texts to findings, so that its tests need no tree.

mod code;
mod direction;
mod files;
mod folders;
mod graph;
mod manifest;
mod members;
mod modules;
mod msrv;
mod names;
pub(crate) mod papers;
mod purity;
mod size;
mod text;
mod tolerances;

use std::fmt;
use std::process::ExitCode;

use anyhow::{Context, Result, bail};

use crate::shell;

pub(crate) use files::tracked;
pub(crate) use text::links::{link_targets, resolve};

/// A tracked text file.
pub(crate) struct Source {
    /// Path from the root, with slashes.
    path: String,
    text: String,
}

/// Something that is not as it should be.
#[derive(Debug, PartialEq)]
pub(crate) struct Finding {
    path: String,
    /// Line number from 1; 0 for the whole file.
    line: usize,
    what: String,
    why: &'static str,
}

impl Finding {
    fn new(path: &str, line: usize, what: impl Into<String>, why: &'static str) -> Self {
        Self { path: path.to_owned(), line, what: what.into(), why }
    }
}

impl fmt::Display for Finding {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(f, "{}:{}: {}: {}", self.path, self.line.max(1), self.what, self.why)
    }
}

pub(crate) fn run(args: &[String]) -> Result<ExitCode> {
    let tree = shell::output(&mut shell::command("cargo", &graph::TREE))?;
    match args {
        [] => {}
        [flag] if flag == "--write" => return write(&tree),
        _ => bail!("usage: cargo xtask tidy [--write]"),
    }
    let paths = files::tracked()?;
    let sources = files::read(&paths)?;

    let mut findings = Vec::new();
    findings.extend(purity::check(&sources));
    findings.extend(direction::check(&sources));
    findings.extend(members::check(&sources));
    findings.extend(modules::check(&sources));
    findings.extend(graph::check(&sources, &tree));
    findings.extend(text::leftovers::check(&sources));
    findings.extend(text::links::check(&sources, &paths));
    findings.extend(names::check(&sources));
    findings.extend(tolerances::check(&sources));
    findings.extend(text::words::check(&sources));
    findings.extend(text::pages::check(&sources));
    findings.extend(text::figures::check(&sources));
    findings.extend(papers::check(&sources));
    findings.extend(folders::check(&sources));
    findings.extend(size::lengths(&sources));
    findings.extend(size::weights(&files::weights(&paths)));
    let linked = "normal,no-proc-macro";
    let kalman_tree = ["tree", "--locked", "-p", "wayfix-kalman", "-e", linked, "--prefix", "none"];
    findings.extend(size::tree("wayfix-kalman", &shell::output(&mut shell::command("cargo", &kalman_tree))?));
    let metadata = ["metadata", "--locked", "--format-version", "1"];
    findings.extend(msrv::check(&sources, &shell::output(&mut shell::command("cargo", &metadata))?));

    for warning in size::long(&sources) {
        println!("warning: {warning}");
    }
    for finding in &findings {
        println!("{finding}");
    }
    println!("tidy: {} files, {} findings", paths.len(), findings.len());
    Ok(if findings.is_empty() { ExitCode::SUCCESS } else { ExitCode::FAILURE })
}

/// Writes the generated diagrams into the docs.
fn write(tree: &str) -> Result<ExitCode> {
    let path = shell::root().join(graph::PAGE);
    let page = std::fs::read_to_string(&path)?;
    let drawn =
        graph::with_picture(&page, tree).context("the marks of the dependency picture are missing")?;
    std::fs::write(path, drawn)?;
    Ok(ExitCode::SUCCESS)
}

#[cfg(test)]
fn source(path: &str, text: &str) -> Source {
    Source { path: path.to_owned(), text: text.to_owned() }
}
