use super::super::number::duration;
use super::super::{FullReport, Metric, PassFailCount, ReportRun, ReportSuite};
use super::{anchor, number_cell, table};
use crate::plot::escape;

/// Verdict, origin and contents.
pub(super) fn header(report: &FullReport) -> String {
    let verdict = verdict(report.tally());
    let seconds: f64 = report.suites.iter().flat_map(|suite| &suite.runs).map(|run| run.seconds).sum();
    let commit = report.commit.as_deref().unwrap_or("unknown");
    let facts = [
        ("commit", format!("<code>{}</code>", escape(commit))),
        ("seed", report.seed.to_string()),
        ("machine", escape(&report.machine.to_string())),
        ("time of all runs", duration(seconds)),
    ];
    let facts: String =
        facts.iter().map(|(term, fact)| format!("<div><dt>{term}</dt><dd>{fact}</dd></div>\n")).collect();
    format!(
        "<header>\n<h1>Wayfix report</h1>\n{verdict}<dl class=\"facts\">\n{facts}</dl>\n{}</header>\n",
        contents(report)
    )
}

/// The runs of a suite side by side, one column a metric; empty for a single run.
pub(super) fn comparison(suite: &ReportSuite, k: usize) -> String {
    if suite.runs.len() < 2 {
        return String::new();
    }
    let mut names: Vec<&str> = Vec::new();
    for metric in suite.runs.iter().flat_map(ReportRun::all_metrics) {
        if !names.contains(&metric.name.as_str()) {
            names.push(&metric.name);
        }
    }
    let heads: Vec<(&str, bool)> =
        std::iter::once(("run", false)).chain(names.iter().map(|name| (*name, true))).collect();
    let row = |(n, run): (usize, &ReportRun)| {
        let cells: String = names
            .iter()
            .map(|name| value_cell(run.all_metrics().find(|metric| metric.name == *name)))
            .collect();
        format!("<tr>{}{cells}</tr>\n", run_head(run, &anchor(k, Some(n))))
    };
    let rows: String = suite.runs.iter().enumerate().map(row).collect();
    table(&format!("{}: all runs", suite.name), &heads, &rows)
}

fn verdict(tally: PassFailCount) -> String {
    let PassFailCount { passed, failed } = tally;
    let (class, words) = match (passed, failed) {
        (0, 0) => ("open", "No figure has a bound".to_owned()),
        (_, 0) => ("pass", format!("All {passed} bounded figures are within their bounds")),
        _ => ("fail", format!("{failed} of {} judged figures failed", passed + failed)),
    };
    format!("<p class=\"verdict {class}\">{words}</p>\n")
}

fn contents(report: &FullReport) -> String {
    let row = |(k, n, suite, run): (usize, usize, &ReportSuite, &ReportRun)| {
        let PassFailCount { passed, failed } = run.tally();
        let class = if failed > 0 { " class=\"failed\"" } else { "" };
        let counts: String = [passed, failed].map(|count| number_cell(Some(count as f64))).concat();
        let time =
            format!("<td class=\"number\" data-value=\"{}\">{}</td>", run.seconds, duration(run.seconds));
        format!(
            "<tr{class}><td>{}</td>{}{counts}{time}</tr>\n",
            escape(&suite.name),
            run_head(run, &anchor(k, Some(n)))
        )
    };
    let suites = report.suites.iter().enumerate();
    let runs =
        suites.flat_map(|(k, suite)| suite.runs.iter().enumerate().map(move |(n, run)| (k, n, suite, run)));
    let rows: String = runs.map(row).collect();
    let heads = [("suite", false), ("run", false), ("passed", true), ("failed", true), ("time", true)];
    if rows.is_empty() { String::new() } else { table("Runs", &heads, &rows) }
}

fn run_head(run: &ReportRun, anchor: &str) -> String {
    format!("<th scope=\"row\"><a href=\"#{anchor}\">{}</a></th>", escape(&run.name))
}

fn value_cell(metric: Option<&Metric>) -> String {
    let cell = number_cell(metric.map(|metric| metric.value));
    if metric.is_some_and(|metric| !metric.passes()) {
        cell.replacen("class=\"number", "class=\"number fail", 1)
    } else {
        cell
    }
}
