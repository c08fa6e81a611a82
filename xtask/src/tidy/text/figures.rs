//! Tables of measured figures that still belong to the plan: every row names a run and a figure of `fixtures/SUITE.toml`.

use std::collections::BTreeSet;

use super::super::{Finding, Source};

const BEGIN: &str = "<!-- figures: ";
const END: &str = "<!-- end figures -->";
const WHY: &str = "`cargo xtask regress`, then `cargo xtask docs --figures`, writes it";

pub(in crate::tidy) fn check(sources: &[Source]) -> Vec<Finding> {
    let pages =
        sources.iter().filter(|source| source.path.starts_with("docs/") && source.path.ends_with(".md"));
    pages
        .flat_map(|page| page.text.split(BEGIN).skip(1).flat_map(move |part| in_place(page, part, sources)))
        .collect()
}

fn in_place(page: &Source, part: &str, sources: &[Source]) -> Vec<Finding> {
    let finding = |what: String| Finding::new(&page.path, 0, what, WHY);
    let Some((suite, table)) =
        part.split_once(" -->\n").and_then(|(suite, rest)| Some((suite, rest.split_once(END)?.0)))
    else {
        return vec![finding("a place for figures is not closed".to_owned())];
    };
    let plan = sources.iter().find(|source| source.path == format!("fixtures/{suite}.toml"));
    let Some(plan) = plan else { return vec![finding(format!("there is no suite `{suite}`"))] };
    let known = figures(&plan.text);
    let rows: Vec<Row> = table.lines().skip(2).filter_map(row).collect();
    let stale = rows.iter().filter(|row| !row.is_compared && !known.contains(&(row.run, row.figure)));
    let mut findings: Vec<_> = stale
        .map(|Row { run, figure, .. }| {
            finding(format!("`{figure}` of `{run}` is not in the plan of {suite}"))
        })
        .collect();
    if rows.is_empty() {
        findings.push(finding(format!("the figures of {suite} are missing")));
    }
    findings
}

/// A row of the table.
struct Row<'a> {
    run: &'a str,
    figure: &'a str,
    /// Whether it has a paper's value that is in the code and not in the plan.
    is_compared: bool,
}

fn row(line: &str) -> Option<Row<'_>> {
    let mut cells = line.split('|').skip(1).map(str::trim);
    let (run, figure) = (cells.next()?, cells.next()?.trim_matches('`'));
    Some(Row { run, figure, is_compared: cells.nth(2).is_some_and(|cell| !cell.is_empty()) })
}

/// Runs of a plan with their figures that have bounds.
fn figures(plan: &str) -> BTreeSet<(&str, &str)> {
    let mut run = "";
    let mut figures = BTreeSet::new();
    for line in plan.lines() {
        if let Some(name) = line.strip_prefix("name = ") {
            run = name.trim().trim_matches('"');
        } else if let Some(metric) = line.strip_prefix("metric = ") {
            figures.insert((run, metric.trim().trim_matches('"')));
        }
    }
    figures
}

#[cfg(test)]
mod tests {
    use super::super::super::source;
    use super::*;

    const PLAN: &str = "[[run]]\nname = \"loop\"\n[[run.bound]]\nmetric = \"ate_rmse_m\"\nhigh = 1\n";

    fn findings(table: &str) -> Vec<Finding> {
        let page = format!("<!-- figures: slam -->\n{table}<!-- end figures -->\n");
        check(&[source("fixtures/slam.toml", PLAN), source("docs/slam.md", &page)])
    }

    #[test]
    fn row_that_the_plan_does_not_know_is_stale() {
        let head = "| run | figure | measured |\n| --- | --- | ---: |\n";
        assert!(findings(&format!("{head}| loop | `ate_rmse_m` | 0.1 m |\n")).is_empty());
        assert_eq!(findings(&format!("{head}| loop | `nees_mean` | 0.1 |\n")).len(), 1);
        assert_eq!(findings(head).len(), 1);
    }
}
