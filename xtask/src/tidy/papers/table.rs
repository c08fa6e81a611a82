//! `docs/papers.toml`: what each paper numbers, and what runs it.

use std::collections::BTreeSet;

use anyhow::{Context, Result, ensure};
use serde::Deserialize;

use super::item::{Item, Kind, items};

const MOST_WORDS: usize = 8;

#[derive(Deserialize)]
#[serde(deny_unknown_fields)]
struct File {
    paper: Vec<Paper>,
}

#[derive(Deserialize)]
#[serde(deny_unknown_fields)]
pub(super) struct Paper {
    /// As in marks.
    pub(super) key: String,
    pub(super) title: String,
    /// Numbers of equations, tables and figures, as counted in the paper.
    pub(super) equations: u32,
    pub(super) tables: u32,
    pub(super) figures: u32,
    pub(super) rows: Vec<Row>,
}

#[derive(Deserialize)]
#[serde(deny_unknown_fields)]
pub(super) struct Row {
    /// `Eq. 9`, `Fig. 1a`, or `Table 1, dark` for a part of a table.
    pub(super) item: String,
    pub(super) what: String,
    /// The command; by default that of the measured figures.
    pub(super) run: Option<String>,
    /// The figure in the paper.
    pub(super) published: Option<String>,
    /// Ours in words, or what the measured figures are.
    pub(super) ours: Option<String>,
    /// `SUITE/RUN/METRIC` each, in the order of the published figures.
    #[serde(default)]
    pub(super) measured: Vec<String>,
    /// Why no command runs it.
    pub(super) missing: Option<String>,
}

impl Row {
    pub(super) fn item(&self) -> Option<Item> {
        items(&self.item).first().copied()
    }
}

/// A measured figure: suite, run, metric.
pub(super) fn parts(measured: &str) -> Option<(&str, &str, &str)> {
    let (suite, rest) = measured.split_once('/')?;
    let (run, metric) = rest.split_once('/')?;
    Some((suite, run, metric))
}

/// The papers, each with a row for every item that it numbers.
pub(super) fn read(text: &str) -> Result<Vec<Paper>> {
    let file: File = toml::from_str(text)?;
    for paper in &file.paper {
        for row in &paper.rows {
            check(row).with_context(|| format!("{}, {}", paper.key, row.item))?;
        }
        let known: BTreeSet<_> = paper.rows.iter().filter_map(Row::item).collect();
        let counts =
            [(Kind::Equation, paper.equations), (Kind::Table, paper.tables), (Kind::Figure, paper.figures)];
        for (kind, n) in counts {
            for number in 1..=n {
                let item = Item { kind, number, part: None };
                let is_there = known.iter().any(|row| item.concerns(*row));
                ensure!(is_there, "{}: no row for {item}", paper.key);
            }
            let beyond = known.iter().find(|item| item.kind == kind && item.number > n);
            ensure!(beyond.is_none(), "{}: {} is beyond the last", paper.key, beyond.expect("there is one"));
        }
    }
    Ok(file.paper)
}

fn check(row: &Row) -> Result<()> {
    let item = row.item().context("is no item")?;
    let n = row.what.split_whitespace().count();
    ensure!((1..=MOST_WORDS).contains(&n), "`what` has {n} words, not 1 to {MOST_WORDS}");
    let mut cells = [&row.run, &row.published, &row.ours, &row.missing].into_iter().flatten();
    ensure!(cells.all(|cell| !cell.is_empty() && !cell.contains('|')), "a cell is empty or has a bar");
    let is_equation = item.kind == Kind::Equation;
    ensure!(is_equation || row.published.is_some(), "`published` is missing");
    let has_ours = row.ours.is_some() || !row.measured.is_empty();
    ensure!(has_ours || is_equation || row.missing.is_some(), "neither `ours` nor `measured` nor `missing`");
    ensure!(row.missing.is_none() || !has_ours, "`missing` beside figures of ours");
    let unreadable = row.measured.iter().find(|measured| parts(measured).is_none());
    ensure!(unreadable.is_none(), "`measured` is SUITE/RUN/METRIC");
    Ok(())
}

#[cfg(test)]
mod tests {
    use super::*;

    fn paper(rows: &str) -> Result<Vec<Paper>> {
        let head = "key = \"Ann 2004\"\ntitle = \"On\"\nequations = 2\ntables = 1\nfigures = 0\n";
        read(&format!("[[paper]]\n{head}rows = [{rows}]\n"))
    }

    const EQUATIONS: &str = "{ item = \"Eq. 1\", what = \"gain\" }, { item = \"Eq. 2\", what = \"mean\", run = \"wayfix run slam\" }";

    #[test]
    fn every_number_has_a_row() {
        let table =
            "{ item = \"Table 1, dark\", what = \"rates\", published = \"1\", measured = [\"a/b/c\"] }";
        assert_eq!(paper(&format!("{EQUATIONS}, {table}")).unwrap()[0].rows.len(), 3);
        let error = paper(EQUATIONS).err().unwrap();
        assert_eq!(error.to_string(), "Ann 2004: no row for Table 1");
        let beyond = "{ item = \"Eq. 3\", what = \"more\" }";
        assert!(paper(&format!("{EQUATIONS}, {table}, {beyond}")).is_err());
    }

    #[test]
    fn rows_are_short_and_say_what_they_lack() {
        let table =
            |rest: &str| paper(&format!("{EQUATIONS}, {{ item = \"Table 1\", what = \"a\", {rest} }}"));
        assert!(table("published = \"1\"").is_err());
        assert!(table("ours = \"1\"").is_err());
        assert!(table("published = \"\", missing = \"private\"").is_err());
        assert!(table("published = \"1\", measured = [\"a/b\"]").is_err());
        assert!(table("published = \"1\", missing = \"private\"").is_ok());
        assert!(table("published = \"1\", missing = \"private\", ours = \"2\"").is_err());
        assert!(paper("{ item = \"Eq. 1\", what = \"a b c d e f g h i\" }").is_err());
    }
}
