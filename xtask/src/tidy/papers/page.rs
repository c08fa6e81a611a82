//! `docs/papers.md`, made of the table, the marks and the measured figures.

use std::collections::BTreeSet;
use std::fmt::Write as _;

use super::super::Source;
use super::marks::{Mark, marks};
use super::measured::Measured;
use super::table::{Paper, Row, parts};

const BEGIN: &str = "<!-- papers -->";
const END: &str = "<!-- end papers -->";
pub(super) const NONE: &str = "none";

/// The whole page.
pub(super) fn page(papers: &[Paper], sources: &[Source], measured: &Measured<'_>) -> String {
    let total = |count: fn(&Paper) -> u32| papers.iter().map(count).sum::<u32>();
    let mut page = format!(
        "# The papers, item by item\n\n{BEGIN}\n\n\
         The {} papers number {} equations, {} tables and {} figures; each has a row. `cargo xtask docs --papers [REPORT]` writes this page from \
         [papers.toml](papers.toml), the marks in the code (`[{}, Eq. 1]`) and a report of `cargo xtask regress`. Measured figures are in the \
         order of the published ones; *(missed)* is outside of the bound in the plan. The papers' own logs are not public: \
         ours are simulated or public ones.\n",
        papers.len(),
        total(|paper| paper.equations),
        total(|paper| paper.tables),
        total(|paper| paper.figures),
        papers.first().map_or("KEY", |paper| &paper.key),
    );
    for paper in papers {
        let _ = write!(
            page,
            "\n## {}\n\n*{}*. Equations: {}, tables: {}, figures: {}.\n\n\
             | item | what it is | in the code | command | published | ours |\n| --- | --- | --- | --- | --- | --- |\n",
            paper.key, paper.title, paper.equations, paper.tables, paper.figures
        );
        let marks = marks(sources, &paper.key);
        for row in &paper.rows {
            let cells = [
                row.item.clone(),
                row.what.clone(),
                places(row, &marks),
                command(row),
                row.published.clone().unwrap_or_else(|| "formula".to_owned()),
                ours(paper, row, measured),
            ];
            let _ = writeln!(page, "| {} |", cells.join(" | "));
        }
    }
    let _ = write!(page, "\n{END}\n");
    page
}

/// Links to the files with a mark of the row, tests only where there is nothing else.
fn places(row: &Row, marks: &[Mark<'_>]) -> String {
    let files = files(row, marks);
    let is_code = |path: &&&str| path.contains("/src/");
    let code: Vec<_> = files.iter().filter(is_code).copied().collect();
    let shown = if code.is_empty() { files.into_iter().collect() } else { code };
    let links: Vec<_> = shown.iter().map(|path| format!("[{}](../{path})", name(path))).collect();
    if links.is_empty() { NONE.to_owned() } else { links.join(", ") }
}

pub(super) fn files<'a>(row: &Row, marks: &[Mark<'a>]) -> BTreeSet<&'a str> {
    let Some(item) = row.item() else { return BTreeSet::new() };
    marks.iter().filter(|mark| mark.item.concerns(item)).map(|mark| mark.path).collect()
}

/// `color-model/lighting/density` for `crates/color-model/src/lighting/density.rs`.
fn name(path: &str) -> String {
    let name = path.trim_start_matches("crates/").trim_end_matches(".rs").replacen("/src/", "/", 1);
    name.trim_end_matches("/mod").to_owned()
}

pub(super) fn command(row: &Row) -> String {
    if let Some(run) = &row.run {
        return format!("`{run}`");
    }
    let runs: BTreeSet<_> = row
        .measured
        .iter()
        .filter_map(|measured| parts(measured))
        .map(|(suite, run, _)| (suite, run))
        .collect();
    let suites: BTreeSet<_> = runs.iter().map(|(suite, _)| *suite).collect();
    let of_suite = |suite: &&str| {
        let names: Vec<_> = runs.iter().filter(|run| run.0 == *suite).map(|(_, run)| *run).collect();
        format!("`cargo xtask regress {suite}`: {}", names.join(", "))
    };
    if suites.is_empty() {
        NONE.to_owned()
    } else {
        suites.iter().map(of_suite).collect::<Vec<_>>().join("; ")
    }
}

fn ours(paper: &Paper, row: &Row, measured: &Measured<'_>) -> String {
    if let Some(missing) = &row.missing {
        return missing.clone();
    }
    let words = row.ours.clone();
    let figures = (!row.measured.is_empty()).then(|| measured.of(&paper.key, row));
    match (words, figures) {
        (None, None) => "as printed".to_owned(),
        (words, figures) => words.into_iter().chain(figures).collect::<Vec<_>>().join(": "),
    }
}
