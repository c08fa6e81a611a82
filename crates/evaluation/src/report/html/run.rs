use std::fmt::Write as _;

use super::super::number::{duration, significant};
use super::super::{ConfidenceInterval, Metric, ReportRun, explanation};
use super::{number_cell, table};
use crate::plot::{SvgPlot, escape};

/// One run: pictures, figures, events, log.
pub(super) fn article(run: &ReportRun, anchor: &str) -> String {
    let figures: String = run.figures.iter().filter(|picture| !picture.svg.is_empty()).map(figure).collect();
    let figures =
        if figures.is_empty() { figures } else { format!("<div class=\"figures\">\n{figures}</div>\n") };
    format!(
        "<article id=\"{anchor}\">\n<h3>{} <small>{}</small></h3>\n{}{figures}{}{}{}</article>\n",
        escape(&run.name),
        duration(run.seconds),
        remarks(run),
        metrics(run),
        events(run),
        log_link(run),
    )
}

fn figure(picture: &SvgPlot) -> String {
    format!("<figure>\n<figcaption>{}</figcaption>\n{}</figure>\n", escape(&picture.title), picture.svg)
}

fn remarks(run: &ReportRun) -> String {
    let error = run
        .error
        .iter()
        .map(|error| format!("<p class=\"verdict fail\">Ended early: {}</p>\n", escape(error)));
    let warnings =
        run.warnings.iter().map(|text| format!("<p class=\"warning\">Warning: {}</p>\n", escape(text)));
    let notes = run.notes.iter().map(|note| format!("<p>{}</p>\n", escape(note)));
    error.chain(warnings).chain(notes).collect()
}

/// The columns for bounds, paper and peers appear only if at least one row has a value.
fn metrics(run: &ReportRun) -> String {
    let heads = [
        ("figure", false),
        ("value", true),
        ("unit", false),
        ("low", true),
        ("high", true),
        ("paper", true),
        ("compared with", true),
        ("bound from", false),
        ("pass", false),
    ];
    let is_compared =
        |metric: &Metric| metric.is_bounded() || metric.paper.is_some() || metric.peer.is_some();
    let compared = run.all_metrics().any(is_compared);
    let heads = if compared { &heads[..] } else { &heads[..3] };
    let rows: String = run.all_metrics().map(|metric| metric_row(metric, compared)).collect();
    if rows.is_empty() { rows } else { table(&format!("Figures of {}", run.name), heads, &rows) }
}

fn metric_row(metric: &Metric, compared: bool) -> String {
    let class = if metric.passes() { "" } else { " class=\"failed\"" };
    let title =
        explanation(&metric.name).map(|meaning| format!(" tabindex=\"0\" title=\"{}\"", escape(meaning)));
    format!(
        "<tr{class}><th scope=\"row\"><code{}>{}</code></th>{}<td>{}</td>{}</tr>\n",
        title.unwrap_or_default(),
        escape(&metric.name),
        value_cell(metric),
        escape(&metric.unit),
        if compared { comparison(metric) } else { String::new() },
    )
}

fn comparison(metric: &Metric) -> String {
    let pass = match (metric.passes(), metric.is_bounded()) {
        (false, _) => "<td class=\"fail\">✗ fail</td>",
        (true, true) => "<td class=\"pass\">✓ pass</td>",
        (true, false) => "<td></td>",
    };
    let numbers: String = [metric.low, metric.high, metric.paper].into_iter().map(number_cell).collect();
    let source = escape(metric.bound_source.as_deref().unwrap_or_default());
    format!("{numbers}{}<td>{source}</td>{pass}", peer_cell(metric))
}

/// The value with its uncertainty.
fn value_cell(metric: &Metric) -> String {
    let cell = number_cell(Some(metric.value));
    match metric.spread {
        Some(ConfidenceInterval { half_width, n }) => {
            let spread = format!(" <small>± {} of {n}</small></td>", significant(half_width));
            cell.replacen("</td>", &spread, 1)
        }
        None => cell,
    }
}

fn peer_cell(metric: &Metric) -> String {
    metric.peer.as_ref().map_or_else(
        || "<td></td>".to_owned(),
        |peer| {
            let (value, name) = (significant(peer.value), escape(&peer.name));
            format!("<td class=\"number\" data-value=\"{}\">{value} <small>{name}</small></td>", peer.value)
        },
    )
}

fn events(run: &ReportRun) -> String {
    let mut rows = String::new();
    for (name, count) in &run.events {
        let _ = writeln!(
            rows,
            "<tr><th scope=\"row\">{}</th>{}</tr>",
            escape(name),
            number_cell(Some(*count as f64))
        );
    }
    if rows.is_empty() {
        rows
    } else {
        table(&format!("Events of {}", run.name), &[("event", false), ("count", true)], &rows)
    }
}

fn log_link(run: &ReportRun) -> String {
    let file = |path: &String| format!("<a href=\"{}\" download>{}</a>", as_reference(path), escape(path));
    let Some(log) = &run.log else { return String::new() };
    let layout = run.layout.as_ref().map(|layout| {
        format!("; for Foxglove there is the layout {} (Layouts, Import from file)", file(layout))
    });
    format!("<p>{}, the estimates for Foxglove and Rerun{}</p>\n", file(log), layout.unwrap_or_default())
}

/// A relative path as a reference: a colon or a quote in a file name is only a character.
fn as_reference(path: &str) -> String {
    let mut reference = String::new();
    for byte in path.replace('\\', "/").bytes() {
        if byte.is_ascii_alphanumeric() || b"/-_.~".contains(&byte) {
            reference.push(char::from(byte));
        } else {
            let _ = write!(reference, "%{byte:02X}");
        }
    }
    reference
}
