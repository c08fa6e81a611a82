//! Every numbered item of the papers: where it is in the code, what runs it, and what comes out beside what was published.

mod item;
mod marks;
mod measured;
mod page;
mod table;

use anyhow::{Context, Result};
use serde_json::Value;

use super::{Finding, Source, files};
use crate::shell;
use marks::{marks, misspelled};
use measured::Measured;
use table::Paper;

const PAGE: &str = "docs/papers.md";
const TABLE: &str = "docs/papers.toml";

/// Writes the page with the figures of a report of `cargo xtask regress`; those that it lacks stay, as all do without one (null).
pub(crate) fn write(report: &Value) -> Result<()> {
    let sources = files::read(&files::tracked()?)?;
    let papers = table::read(text(&sources, TABLE)).context(TABLE)?;
    let measured = Measured::new(text(&sources, PAGE), report);
    std::fs::write(shell::root().join(PAGE), page::page(&papers, &sources, &measured))?;
    println!("docs: {PAGE}");
    measured.check(&papers)
}

pub(super) fn check(sources: &[Source]) -> Vec<Finding> {
    let papers = match table::read(text(sources, TABLE)) {
        Ok(papers) => papers,
        Err(error) => {
            return vec![Finding::new(TABLE, 0, format!("{error:#}"), "every item has a row of its own")];
        }
    };
    let keys: Vec<_> = papers.iter().map(|paper| paper.key.as_str()).collect();
    let mut findings = misspelled(sources, &keys);
    for paper in &papers {
        findings.extend(in_paper(paper, sources));
    }
    let now = text(sources, PAGE);
    if now != page::page(&papers, sources, &Measured::new(now, &Value::Null)) {
        findings.push(Finding::new(PAGE, 0, "stale", "`cargo xtask docs --papers` writes it"));
    }
    findings
}

fn in_paper(paper: &Paper, sources: &[Source]) -> Vec<Finding> {
    let marks = marks(sources, &paper.key);
    let is_known = |mark: &&marks::Mark<'_>| {
        paper.rows.iter().filter_map(table::Row::item).any(|row| mark.item.concerns(row))
    };
    let unknown = marks.iter().filter(|mark| !is_known(mark)).map(|mark| {
        Finding::new(
            mark.path,
            mark.line,
            mark.item.to_string(),
            "docs/papers.toml has no such item of the paper",
        )
    });
    let mut findings: Vec<_> = unknown.collect();
    for row in &paper.rows {
        let mut found = |what: &str, why| {
            findings.push(Finding::new(TABLE, 0, format!("{}, {}: {what}", paper.key, row.item), why));
        };
        if row.missing.is_none() && page::files(row, &marks).is_empty() {
            found("no mark in the code", "mark what implements it, or say in `missing` why nothing does");
        }
        if row.missing.is_none() && page::command(row) == page::NONE {
            found("no command", "say what runs it, or in `missing` why nothing does");
        }
        for measured in &row.measured {
            if !is_planned(sources, measured) {
                found(measured, "no plan in `fixtures` has this run");
            }
        }
    }
    findings
}

/// Whether the plan of the suite has the run.
fn is_planned(sources: &[Source], measured: &str) -> bool {
    let Some((suite, run, _)) = table::parts(measured) else { return false };
    let name = format!("name = \"{run}\"");
    text(sources, &format!("fixtures/{suite}.toml")).lines().any(|line| line == name)
}

fn text<'a>(sources: &'a [Source], path: &str) -> &'a str {
    sources.iter().find(|source| source.path == path).map_or("", |source| &source.text)
}

#[cfg(test)]
mod tests;
