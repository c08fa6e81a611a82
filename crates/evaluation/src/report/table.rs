//! A report for the terminal.

use console::{measure_text_width, truncate_str};

use super::number::{duration, significant, significant_or_empty};
use super::{FullReport, Metric, ReportRun};

/// Style of a table.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct TableStyle {
    /// Width of the terminal, in columns. Table columns that do not fit are dropped from the right, and long names are cut.
    pub width: usize,
    /// Whether ✓ and ✗ are coloured.
    pub colour: bool,
}

impl TableStyle {
    /// 100 columns without colour.
    pub const PLAIN: Self = Self { width: 100, colour: false };

    /// Style for standard output: without colour if it is no terminal or `NO_COLOR` is set.
    pub fn of_stdout() -> Self {
        let terminal = console::Term::stdout();
        let width = terminal.size_checked().map_or(Self::PLAIN.width, |(_, columns)| usize::from(columns));
        Self { width, colour: terminal.is_term() && console::colors_enabled() }
    }
}

/// Every run of the report, and the tally.
///
/// ```
/// use wayfix_evaluation::report::{Metric, FullReport, ReportRun, ReportSuite, table};
/// let run = ReportRun { name: "robot 1".to_owned(), metrics: vec![Metric::new("ate_rmse_m", 0.2, "m").at_most(0.1)], ..ReportRun::default() };
/// let report = FullReport { suites: vec![ReportSuite { name: "slam".to_owned(), runs: vec![run] }], ..FullReport::default() };
/// let text = table::report(&report, table::TableStyle::PLAIN);
/// assert!(text.contains("✗ ate_rmse_m") && text.contains("0 within bounds, 1 not\nfirst failure: slam / robot 1: ate_rmse_m"));
/// ```
pub fn report(report: &FullReport, style: TableStyle) -> String {
    let mut text = String::new();
    for suite in &report.suites {
        for run_of_suite in &suite.runs {
            text += &format!("{} / {} ({})\n", suite.name, run_of_suite.name, duration(run_of_suite.seconds));
            text += &run(run_of_suite, style);
            text.push('\n');
        }
    }
    text + &super::verdicts::tally(report)
}

/// Metrics, timings and events of one run.
pub fn run(run: &ReportRun, style: TableStyle) -> String {
    let rows: Vec<Row> =
        std::iter::once(HEADER.map(str::to_owned)).chain(run.all_metrics().map(row)).collect();
    let mut text = set(&rows, style);
    if let Some(error) = &run.error {
        text += &format!("{} ended early: {error}\n", mark(false, style.colour));
    }
    if !run.events.is_empty() {
        let events: Vec<String> = run.events.iter().map(|(name, count)| format!("{name} {count}")).collect();
        text += &format!("  events: {}\n", events.join(", "));
    }
    text
}

const N_COLUMNS: usize = 9;
type Row = [String; N_COLUMNS];
const HEADER: [&str; N_COLUMNS] =
    ["", "figure", "value", "unit", "low", "high", "paper", "compared with", "bound from"];
const GAP: usize = 2;

fn row(metric: &Metric) -> Row {
    let mark = if metric.passes() && !metric.is_bounded() {
        ""
    } else if metric.passes() {
        PASS
    } else {
        FAIL
    };
    let peer = metric
        .peer
        .as_ref()
        .map_or_else(String::new, |peer| format!("{} ({})", significant(peer.value), peer.name));
    [
        mark.to_owned(),
        metric.name.clone(),
        value(metric),
        metric.unit.clone(),
        significant_or_empty(metric.low),
        significant_or_empty(metric.high),
        significant_or_empty(metric.paper),
        peer,
        metric.bound_source.clone().unwrap_or_default(),
    ]
}

/// The value with its uncertainty.
fn value(metric: &Metric) -> String {
    let value = significant(metric.value);
    match metric.spread {
        Some(spread) => format!("{value} ± {}", significant(spread.half_width)),
        None => value,
    }
}

const PASS: &str = "✓";
const FAIL: &str = "✗";

pub(super) fn mark(passes: bool, colour: bool) -> String {
    match (passes, colour) {
        (true, false) => PASS.to_owned(),
        (false, false) => FAIL.to_owned(),
        (true, true) => format!("\u{1b}[32m{PASS}\u{1b}[0m"),
        (false, true) => format!("\u{1b}[31m{FAIL}\u{1b}[0m"),
    }
}

/// Aligns the non-empty columns, as many as fit.
fn set(rows: &[Row], style: TableStyle) -> String {
    let width_of = |k: usize| rows.iter().map(|row| measure_text_width(&row[k])).max().unwrap_or(0);
    let is_used = |k: &usize| rows.iter().skip(1).any(|row| !row[*k].is_empty());
    let mut columns: Vec<(usize, usize)> = (0..N_COLUMNS).filter(is_used).map(|k| (k, width_of(k))).collect();
    let total = |columns: &[(usize, usize)]| {
        columns.iter().map(|(_, width)| width + GAP).sum::<usize>().saturating_sub(GAP)
    };
    while total(&columns) > style.width && columns.last().is_some_and(|(k, _)| *k > VALUE) {
        columns.pop();
    }
    let excess = total(&columns).saturating_sub(style.width);
    if let Some((_, width)) = columns.iter_mut().find(|(k, _)| *k == NAME) {
        *width = width.saturating_sub(excess).max(4);
    }
    rows.iter().map(|row| set_row(row, &columns, style) + "\n").collect()
}

/// Columns that are never dropped.
const MARK: usize = 0;
const NAME: usize = 1;
const VALUE: usize = 2;

fn set_row(row: &Row, columns: &[(usize, usize)], style: TableStyle) -> String {
    let mut line = String::new();
    for (k, width) in columns {
        line += &set_cell(*k, &row[*k], *width, style.colour);
        // The mark belongs to the name.
        line += &" ".repeat(if *k == MARK { 1 } else { GAP });
    }
    line.trim_end().to_owned()
}

fn set_cell(column: usize, text: &str, width: usize, colour: bool) -> String {
    let cut = truncate_str(text, width, "…");
    let blank = " ".repeat(width.saturating_sub(measure_text_width(&cut)));
    match column {
        MARK if !text.is_empty() => mark(text == PASS, colour),
        VALUE | 4..=6 => blank + &cut,
        _ => cut.into_owned() + &blank,
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn example() -> ReportRun {
        let metrics = vec![
            Metric::new("ate_aligned_rmse_m", 0.121, "m")
                .at_most(0.164)
                .paper(0.2)
                .peer("numpy", 0.208)
                .bound_from("accuracy.md"),
            Metric::new("nees_mean", 5.5, "").at_least(2.0).at_most(4.0),
            Metric::new("n_landmarks", 15.0, ""),
        ];
        ReportRun { name: "r".to_owned(), metrics, ..ReportRun::default() }
    }

    /// Position in characters, not bytes.
    fn column_of(line: &str, text: &str) -> usize {
        line[..line.find(text).unwrap()].chars().count()
    }

    #[test]
    fn columns_are_aligned() {
        let text = run(&example(), TableStyle::PLAIN);
        let lines: Vec<&str> = text.lines().collect();
        let names = ["figure", "ate_aligned_rmse_m", "nees_mean", "n_landmarks"];
        for (line, name) in lines.iter().zip(names) {
            assert_eq!(column_of(line, name), 2, "{line}");
        }
        let end = |line: &str, text: &str| column_of(line, text) + text.chars().count();
        assert_eq!(end(lines[0], "value"), end(lines[1], "0.1210"));
        assert_eq!(end(lines[0], "value"), end(lines[3], "15"));
        assert!(lines[1].starts_with("✓ ") && lines[2].starts_with("✗ ") && lines[3].starts_with("  "));
    }

    #[test]
    fn fits_the_width_and_keeps_name_and_value() {
        for width in [16, 20, 40, 60, 80] {
            let text = run(&example(), TableStyle { width, colour: false });
            assert!(text.lines().all(|line| line.chars().count() <= width), "{width}: {text}");
            assert!(text.contains("0.1210") && text.contains("5.500"), "{text}");
        }
    }

    #[test]
    fn colour_only_on_request() {
        assert!(!run(&example(), TableStyle::PLAIN).contains('\u{1b}'));
        assert!(run(&example(), TableStyle { colour: true, ..TableStyle::PLAIN }).contains("\u{1b}[31m✗"));
    }
}
