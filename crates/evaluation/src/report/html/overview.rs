use super::super::number::{duration, significant};
use super::super::{FullReport, Metric, PassFailCount, ReportRun, ReportSuite};
use super::{anchor, number_cell, table};
use crate::plot::escape;

/// Verdict, origin and contents. A run of a user's log has neither bounds nor a revision: results and warnings stand there instead.
pub(super) fn header(report: &FullReport) -> String {
    let seconds: f64 = report.runs().map(|(_, run)| run.seconds).sum();
    let revision =
        report.commit.as_deref().map(|commit| ("commit", format!("<code>{}</code>", escape(commit))));
    let facts = revision.into_iter().chain([
        ("seed", report.seed.to_string()),
        ("machine", escape(&report.machine.to_string())),
        ("time of all runs", duration(seconds)),
    ]);
    let facts: String =
        facts.map(|(term, fact)| format!("<div><dt>{term}</dt><dd>{fact}</dd></div>\n")).collect();
    format!(
        "<header>\n<h1>Wayfix report</h1>\n{}{}<dl class=\"facts\">\n{facts}</dl>\n{}</header>\n",
        verdict(report),
        open(report),
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

fn verdict(report: &FullReport) -> String {
    let PassFailCount { passed, failed } = report.tally();
    let paragraph =
        |class: &str, words: &str| format!("<p class=\"verdict {class}\">{}</p>\n", escape(words));
    let mut text = match (passed, failed) {
        (0, 0) => paragraph("open", &found(report)),
        (_, 0) => paragraph("pass", &format!("All {passed} bounded figures are within their bounds")),
        _ => paragraph("fail", &format!("{failed} of {} judged figures failed", passed + failed)),
    };
    if let Some(first) = report.first_failure() {
        text += &paragraph("fail", &format!("First failure: {first}"));
    }
    if !report.pending.is_empty() {
        text += &paragraph("open", &format!("Not finished: {}", report.pending.join(", ")));
    }
    text
}

/// Results and warnings of runs without bounds.
fn found(report: &FullReport) -> String {
    let n_doubts: usize = report.runs().map(|(_, run)| run.warnings.len()).sum();
    let n_figures: usize = report.runs().map(|(_, run)| run.all_metrics().count()).sum();
    match n_doubts {
        0 => format!("{n_figures} figures, no warnings"),
        1 => format!("{n_figures} figures; 1 warning about doubtful results"),
        n => format!("{n_figures} figures; {n} warnings about doubtful results"),
    }
}

/// Bounds that are wanted and not counted yet.
fn open(report: &FullReport) -> String {
    let item = |(suite, run, metric): (&str, &str, &Metric)| {
        let wanted = metric.bound_source.as_deref().unwrap_or_default();
        let name = format!("{suite} / {run}: {}", metric.name);
        format!("<li>{} {}, {}</li>\n", escape(&name), significant(metric.value), escape(wanted))
    };
    let items: String = report.open_metrics().map(item).collect();
    let n = report.open_metrics().count();
    match n {
        0 => String::new(),
        n => format!(
            "<details><summary>{n} open: wanted, not counted</summary>\n<ul>\n{items}</ul></details>\n"
        ),
    }
}

/// A row a run; a single run without bounds needs none.
fn contents(report: &FullReport) -> String {
    let is_judged = report.tally() != PassFailCount::default();
    if !is_judged && report.runs().count() < 2 {
        return String::new();
    }
    let row = |(k, n, suite, run): (usize, usize, &ReportSuite, &ReportRun)| {
        let PassFailCount { passed, failed } = run.tally();
        let class = if failed > 0 { " class=\"failed\"" } else { "" };
        let counts = [passed, failed].map(|count| number_cell(Some(count as f64))).concat();
        let counts = if is_judged { counts } else { String::new() };
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
    let counts = [("passed", true), ("failed", true)];
    let counts = if is_judged { &counts[..] } else { &[] };
    let heads = [&[("suite", false), ("run", false)], counts, &[("time", true)]].concat();
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
