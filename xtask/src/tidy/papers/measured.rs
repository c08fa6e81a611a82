//! Measured figures: from a report, or as the page has them.

use std::collections::BTreeMap;

use anyhow::{Result, bail};
use serde_json::Value;

use super::table::{Paper, Row, parts};
use crate::docs::measured;

const UNKNOWN: &str = "not in the last report";
const BETWEEN: &str = ", ";

pub(super) struct Measured<'a> {
    /// The last cell of each row of the page, by paper and item.
    page: BTreeMap<(&'a str, &'a str), &'a str>,
    report: &'a Value,
}

impl<'a> Measured<'a> {
    /// Without a report (null), as the page has them.
    pub(super) fn new(page: &'a str, report: &'a Value) -> Self {
        let mut key = "";
        let mut cells = BTreeMap::new();
        for line in page.lines() {
            if let Some(heading) = line.strip_prefix("## ") {
                key = heading;
            } else if let Some(row) = line.strip_prefix("| ").and_then(|row| row.strip_suffix(" |")) {
                let of_row: Vec<_> = row.split(" | ").collect();
                if let [item, .., ours] = of_row[..] {
                    cells.insert((key, item), ours);
                }
            }
        }
        Self { page: cells, report }
    }

    /// The figures of a row: those of the report, others as before.
    pub(super) fn of(&self, key: &str, row: &Row) -> String {
        let before = self.page.get(&(key, row.item.as_str())).copied().unwrap_or_default();
        let words = row.ours.as_ref().map(|words| format!("{words}: ")).unwrap_or_default();
        let before: Vec<_> = before.strip_prefix(&words).unwrap_or_default().split(BETWEEN).collect();
        let before =
            if before.len() == row.measured.len() { before } else { vec![UNKNOWN; row.measured.len()] };
        let figure = |(name, before): (&String, &str)| {
            self.in_report(name).map_or_else(|| before.to_owned(), measured)
        };
        let figures: Vec<_> = row.measured.iter().zip(before).map(figure).collect();
        if figures.iter().all(|figure| figure == UNKNOWN) {
            UNKNOWN.to_owned()
        } else {
            figures.join(BETWEEN)
        }
    }

    fn in_report(&self, name: &str) -> Option<&'a Value> {
        let (suite, run, metric) = parts(name)?;
        named(&self.run(suite, run)?["metrics"], metric)
    }

    fn run(&self, suite: &str, run: &str) -> Option<&'a Value> {
        named(&named(&self.report["suites"], suite)?["runs"], run)
    }

    /// Fails on a figure that the report's run does not have.
    pub(super) fn check(&self, papers: &[Paper]) -> Result<()> {
        let rows = papers.iter().flat_map(|paper| &paper.rows);
        for name in rows.flat_map(|row| &row.measured) {
            let has_run = parts(name).is_some_and(|(suite, run, _)| self.run(suite, run).is_some());
            if has_run && self.in_report(name).is_none() {
                bail!("the report has no {name}");
            }
        }
        Ok(())
    }
}

fn named<'a>(list: &'a Value, name: &str) -> Option<&'a Value> {
    list.as_array()?.iter().find(|found| found["name"] == name)
}
