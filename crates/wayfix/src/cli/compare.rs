use std::{
    fs,
    path::{Path, PathBuf},
    process::ExitCode,
};

use anyhow::{Context, Result, ensure};
use wayfix_evaluation::{
    plot::SvgPlot,
    report::{FullReport, Metric, PeerValue, ReportRun, ReportSuite, table, table::TableStyle},
    terminal::print,
};

use super::outputs::figure_file;

/// Compare two reports: the figures of B next to those of A.
///
/// Runs are matched by suite and name. Two reports with one run each, of the same suite, are compared even if the names differ. Figures in only
/// one report are skipped and counted. Times are not compared. A page of `--out` has the pictures of two runs beside each other.
#[derive(clap::Args)]
#[command(after_long_help = EXAMPLES)]
pub(super) struct Arguments {
    /// The report to compare with: a folder of `--out`, or its report.json.
    a: PathBuf,
    /// The report whose figures are judged.
    b: PathBuf,
    /// Show equal figures too.
    #[arg(long)]
    all: bool,
    /// Folder for a page with the same comparison.
    #[arg(long, value_name = "DIR")]
    out: Option<PathBuf>,
}

const EXAMPLES: &str = "\
Examples:
  wayfix compare monday tuesday
  wayfix compare target/before target/regress --out target/comparison";

pub(super) fn main(arguments: Arguments) -> Result<ExitCode> {
    let (a, b) = (read(&arguments.a)?, read(&arguments.b)?);
    let names = [&arguments.a, &arguments.b].map(|path| path.display().to_string());
    let compared = compared(&a, &b, &names, arguments.all);
    ensure!(!compared.suites.is_empty() || has_common_run(&a, &b), "the two reports have no run in common");
    if let Some(out) = &arguments.out {
        compared.write(out)?;
    }
    let n_changed: usize = compared.runs().map(|(_, run)| run.metrics.len()).sum();
    print(table::report(&compared, TableStyle::of_stdout()))?;
    let pairs = b.runs().filter_map(|(suite, run)| Some((run, counterpart(&a, &b, suite, run)?)));
    let (n_of_a, n_of_b) =
        pairs.fold((0, 0), |(n, m), (run, other)| (n + n_alone(other, run), m + n_alone(run, other)));
    let verb = if arguments.all { "in both" } else { "differ" };
    print(format!("{n_changed} figures {verb}. {} Times are not compared.\n", alone(n_of_a, n_of_b)))?;
    Ok(ExitCode::SUCCESS)
}

fn read(path: &Path) -> Result<FullReport> {
    let file = if path.is_dir() { path.join("report.json") } else { path.to_owned() };
    let text = fs::read(&file).with_context(|| format!("cannot read {}", file.display()))?;
    let mut report: FullReport =
        serde_json::from_slice(&text).with_context(|| format!("{} is no report", file.display()))?;
    // Only a report of one run has its pictures as files.
    if file.ends_with("report.json")
        && let [ReportSuite { runs, .. }] = &mut report.suites[..]
        && let [run] = &mut runs[..]
    {
        for (number, figure) in run.figures.iter_mut().enumerate() {
            figure.svg = inline(&file.with_file_name(figure_file(number))).unwrap_or_default();
        }
    }
    Ok(report)
}

/// The drawing of a picture's file, without its palette: the page has its own.
fn inline(path: &Path) -> Option<String> {
    let text = fs::read_to_string(path).ok()?;
    let (before, rest) = text.split_once("<style>")?;
    let (_, after) = rest.split_once("</style>")?;
    Some(format!("{before}{after}"))
}

/// The pictures of both runs that have the same title, one beside the other.
fn pictures(run: &ReportRun, other: &ReportRun, [a, b]: &[String; 2]) -> Vec<SvgPlot> {
    let drawn =
        |run: &ReportRun| run.figures.iter().filter(|figure| !figure.svg.is_empty()).cloned().collect();
    let (figures, others): (Vec<SvgPlot>, Vec<SvgPlot>) = (drawn(run), drawn(other));
    let named =
        |figure: SvgPlot, name: &str| SvgPlot { title: format!("{name}: {}", figure.title), ..figure };
    let beside = |figure: SvgPlot| {
        let other = others.iter().find(|other| other.title == figure.title)?.clone();
        Some([named(other, a), named(figure, b)])
    };
    figures.into_iter().filter_map(beside).flatten().collect()
}

/// The report of B, with the figures of A as those of another program.
fn compared(a: &FullReport, b: &FullReport, names: &[String; 2], all: bool) -> FullReport {
    let suite = |suite: &ReportSuite| {
        let runs = suite.runs.iter().filter_map(|run| {
            let other = counterpart(a, b, &suite.name, run)?;
            let metrics: Vec<Metric> =
                run.metrics.iter().filter_map(|metric| beside(metric, other, &names[0], all)).collect();
            let (n_of_a, n_of_b) = (n_alone(other, run), n_alone(run, other));
            let notes = (n_of_a + n_of_b > 0).then(|| alone(n_of_a, n_of_b));
            let kept = ReportRun {
                figures: pictures(run, other, names),
                timings: Vec::new(),
                log: None,
                layout: None,
                ..run.clone()
            };
            Some(ReportRun { metrics, notes: notes.into_iter().collect(), ..kept })
        });
        let runs: Vec<ReportRun> =
            runs.filter(|run| !run.metrics.is_empty() || !run.figures.is_empty()).collect();
        (!runs.is_empty()).then(|| ReportSuite { name: suite.name.clone(), runs })
    };
    FullReport { suites: b.suites.iter().filter_map(suite).collect(), ..b.clone() }
}

fn counterpart<'a>(a: &'a FullReport, b: &FullReport, suite: &str, run: &ReportRun) -> Option<&'a ReportRun> {
    let mut in_suite = a.runs().filter(|(other, _)| *other == suite);
    let by_name = a.runs().find(|(other_suite, other)| *other_suite == suite && other.name == run.name);
    let only = || (a.runs().count() == 1 && b.runs().count() == 1).then(|| in_suite.next()).flatten();
    by_name.or_else(only).map(|(_, other)| other)
}

fn has_common_run(a: &FullReport, b: &FullReport) -> bool {
    b.runs().any(|(suite, run)| counterpart(a, b, suite, run).is_some())
}

fn value_in(run: &ReportRun, name: &str) -> Option<f64> {
    run.metrics.iter().find(|metric| metric.name == name).map(|metric| metric.value)
}

/// Number of figures of a run that the other lacks.
fn n_alone(run: &ReportRun, other: &ReportRun) -> usize {
    run.metrics.iter().filter(|metric| value_in(other, &metric.name).is_none()).count()
}

/// These numbers in words.
fn alone(n_of_a: usize, n_of_b: usize) -> String {
    format!("{n_of_a} figures are in A only, {n_of_b} in B only.")
}

/// The figure with that of the other run; `None` if the other lacks it, or if they are equal and only differences count.
fn beside(metric: &Metric, other: &ReportRun, name: &str, all: bool) -> Option<Metric> {
    let value = value_in(other, &metric.name)?;
    let is_equal = value == metric.value || value.is_nan() && metric.value.is_nan();
    (all || !is_equal)
        .then(|| Metric { peer: Some(PeerValue { name: name.to_owned(), value }), ..metric.clone() })
}

#[cfg(test)]
mod tests {
    use super::*;

    fn report(run: &str, values: &[(&str, f64)]) -> FullReport {
        let metrics = values.iter().map(|(name, value)| Metric::new(*name, *value, "m")).collect();
        let run = ReportRun { name: run.to_owned(), metrics, ..ReportRun::default() };
        FullReport {
            suites: vec![ReportSuite { name: "slam".to_owned(), runs: vec![run] }],
            ..FullReport::default()
        }
    }

    #[test]
    fn pictures_of_one_title_stand_beside_each_other() {
        let figure = |title: &str, svg: &str| SvgPlot {
            title: title.to_owned(),
            svg: svg.to_owned(),
            ..SvgPlot::default()
        };
        let run = |figures| ReportRun { figures, ..ReportRun::default() };
        let a = run(vec![figure("Path", "<svg>a</svg>"), figure("Only A", "<svg/>")]);
        let b = run(vec![figure("Path", "<svg>b</svg>"), figure("Without a file", "")]);
        let titles: Vec<String> =
            pictures(&b, &a, &["A", "B"].map(str::to_owned)).into_iter().map(|figure| figure.title).collect();
        assert_eq!(titles, ["A: Path", "B: Path"]);
    }

    #[test]
    fn figures_that_differ_stand_beside_each_other() {
        let a = report("monday", &[("ate_rmse_m", 0.2), ("n_landmarks", 15.0)]);
        let b = report("tuesday", &[("ate_rmse_m", 0.1), ("n_landmarks", 15.0), ("nees_mean", 3.0)]);
        let names = ["A", "B"].map(str::to_owned);
        let found = compared(&a, &b, &names, false);
        let run = &found.suites[0].runs[0];
        assert_eq!(run.metrics.len(), 1);
        assert_eq!((run.metrics[0].value, run.metrics[0].peer.as_ref().unwrap().value), (0.1, 0.2));
        assert_eq!(run.notes, ["0 figures are in A only, 1 in B only."]);
        assert_eq!(compared(&a, &b, &names, true).suites[0].runs[0].metrics.len(), 2);
        assert!(compared(&a, &a, &names, false).suites.is_empty() && has_common_run(&a, &a));
    }
}
