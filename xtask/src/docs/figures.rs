//! `cargo xtask docs --figures [REPORT]`: the tables of measured figures in the guides, written from a report of `cargo xtask regress`.

use std::fmt::Write as _;
use std::path::Path;
use std::process::ExitCode;

use anyhow::{Context, Result, bail};
use serde_json::Value;

use crate::{regress, shell};

/// Start marker of a table, before the name of a suite.
const BEGIN: &str = "<!-- figures: ";
const END: &str = "<!-- end figures -->";

pub(super) fn run(args: &[String]) -> Result<ExitCode> {
    let report = match args {
        [] => shell::root().join(regress::default_out()).join("report.json"),
        [report] => report.into(),
        _ => bail!("usage: cargo xtask docs --figures [REPORT.json]"),
    };
    let report = read(&report)?;
    for page in pages(&shell::root().join("docs"))? {
        let text = std::fs::read_to_string(&page)?;
        let written = with_tables(&text, &report).with_context(|| page.display().to_string())?;
        if written != text {
            std::fs::write(&page, written)?;
            println!("docs: figures of {}", page.display());
        }
    }
    Ok(ExitCode::SUCCESS)
}

/// The report in the file of this name.
pub(super) fn read(report: &Path) -> Result<Value> {
    let text = std::fs::read_to_string(report)
        .with_context(|| format!("{}: `cargo xtask regress` writes it", report.display()))?;
    Ok(serde_json::from_str(&text)?)
}

/// The pages in a folder, in the order of their names.
pub(super) fn pages(folder: &Path) -> Result<Vec<std::path::PathBuf>> {
    let entries = std::fs::read_dir(folder)?.collect::<std::io::Result<Vec<_>>>()?;
    let mut pages: Vec<_> = entries.into_iter().map(|entry| entry.path()).collect();
    pages.retain(|page| page.extension().is_some_and(|extension| extension == "md"));
    pages.sort();
    Ok(pages)
}

/// The page with the tables of the suites in the report; other tables are unchanged.
fn with_tables(page: &str, report: &Value) -> Result<String> {
    let mut parts = page.split(BEGIN);
    let mut written = parts.next().unwrap_or_default().to_owned();
    for part in parts {
        let (suite, rest) = part.split_once(" -->\n").context("a place for figures names no suite")?;
        let (table, after) = rest.split_once(END).context("a place for figures has no end")?;
        let new = report["suites"].as_array().into_iter().flatten().find(|found| found["name"] == suite);
        let table = new.map_or_else(|| table.to_owned(), of_suite);
        let _ = write!(written, "{BEGIN}{suite} -->\n{table}{END}{after}");
    }
    Ok(written)
}

/// A row for each figure with a bound, an open goal, or a value of a paper or another program.
fn of_suite(suite: &Value) -> String {
    let mut table = String::from(
        "| run | figure | measured | bound | compared with |\n| --- | --- | ---: | --- | --- |\n",
    );
    for run in suite["runs"].as_array().into_iter().flatten() {
        let metrics = ["metrics"].iter().filter_map(|kind| run[*kind].as_array()).flatten();
        for metric in metrics.filter(|metric| is_compared(metric)) {
            let cells = [
                text(&run["name"]),
                format!("`{}`", text(&metric["name"])),
                measured(metric),
                bound(metric),
                compared(metric),
            ];
            let _ = writeln!(table, "| {} |", cells.join(" | "));
        }
    }
    table
}

fn is_compared(metric: &Value) -> bool {
    let counts_changes = metric["name"] == "n_figures_changed"; // of this report against an earlier one
    let has_bound = ["low", "high", "paper"].iter().any(|key| metric[*key].is_number());
    !counts_changes && (has_bound || metric["open"] == true || metric["peer"].is_object())
}

fn text(value: &Value) -> String {
    value.as_str().unwrap_or_default().to_owned()
}

/// Three digits, the most that is reproducible on another log.
fn number(value: &Value) -> Option<String> {
    let value = value.as_f64()?;
    let digits = (2 - value.abs().max(1e-9).log10().floor() as i32).clamp(0, 6) as usize;
    let text = format!("{value:.digits$}");
    Some(if digits > 0 { text.trim_end_matches('0').trim_end_matches('.').to_owned() } else { text })
}

/// Value, unit, and whether it is outside of its bound.
pub(crate) fn measured(metric: &Value) -> String {
    let value = number(&metric["value"]).unwrap_or_else(|| "–".to_owned());
    let missed = (metric["pass"] == Value::Bool(false)).then(|| "(missed)".to_owned());
    let unit = Some(text(&metric["unit"])).filter(|unit| !unit.is_empty());
    [Some(value), unit, missed].into_iter().flatten().collect::<Vec<_>>().join(" ")
}

fn bound(metric: &Value) -> String {
    if metric["open"] == true {
        // "open, wanted at most 3: …"
        let source = text(&metric["bound_source"]);
        return source.split_once(':').map_or(source.clone(), |(wanted, _)| wanted.to_owned());
    }
    match (number(&metric["low"]), number(&metric["high"])) {
        (Some(low), Some(high)) if low == high => low,
        (Some(low), Some(high)) => format!("{low} to {high}"),
        (Some(low), None) => format!("≥ {low}"),
        (None, Some(high)) => format!("≤ {high}"),
        (None, None) => String::new(),
    }
}

fn compared(metric: &Value) -> String {
    let paper = number(&metric["paper"]).map(|value| format!("paper {value}"));
    let peer = &metric["peer"];
    let peer = number(&peer["value"]).map(|value| format!("{} {value}", text(&peer["name"])));
    paper.into_iter().chain(peer).collect::<Vec<_>>().join(", ")
}

#[cfg(test)]
mod tests {
    use serde_json::json;

    use super::*;

    #[test]
    fn table_of_a_suite_is_written_between_its_marks() {
        let report = json!({"suites": [{"name": "slam", "runs": [{"name": "loop", "metrics": [
            {"name": "ate_rmse_m", "value": 0.050_61, "unit": "m", "low": 0.0496, "high": 0.0516, "paper": null, "pass": true,
             "peer": {"name": "numpy EKF", "value": 0.0506}},
            {"name": "n_landmarks", "value": 50.0, "unit": "", "low": 51.0, "high": 51.0, "paper": null, "pass": false},
            {"name": "goal", "value": 0.2, "unit": "m", "low": null, "high": null, "paper": null, "pass": true, "open": true,
             "bound_source": "open, wanted at most 0.1: design goal"},
            {"name": "no_bound", "value": 1.0, "unit": "", "low": null, "high": null, "paper": null, "pass": true},
        ]}]}]});
        let page = "a\n<!-- figures: slam -->\nold\n<!-- end figures -->\nb\n<!-- figures: color -->\nkept\n<!-- end figures -->\n";
        let written = with_tables(page, &report).unwrap();
        assert!(
            written.contains("| loop | `ate_rmse_m` | 0.0506 m | 0.0496 to 0.0516 | numpy EKF 0.0506 |\n"),
            "{written}"
        );
        assert!(written.contains("| loop | `n_landmarks` | 50 (missed) | 51 |  |\n"), "{written}");
        assert!(written.contains("| loop | `goal` | 0.2 m | open, wanted at most 0.1 |  |\n"), "{written}");
        assert!(
            written.contains("kept") && !written.contains("old") && !written.contains("no_bound"),
            "{written}"
        );
        assert_eq!(with_tables(&written, &report).unwrap(), written);
    }

    #[test]
    fn place_without_an_end_is_an_error() {
        assert!(with_tables("<!-- figures: slam -->\n", &json!({"suites": []})).is_err());
    }
}
