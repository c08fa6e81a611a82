//! The report as one page that works offline: styles, pictures and a short script are embedded.

mod overview;
mod run;

use super::{FullReport, ReportSuite};
use crate::plot::{DARK_PALETTE, LIGHT_PALETTE, escape, named_palette};

/// The page.
///
/// ```
/// use wayfix_evaluation::report::{FullReport, html};
/// let page = html::render(&FullReport::default());
/// assert!(page.starts_with("<!doctype html>") && !page.contains("http://") && !page.contains("https://"));
/// ```
pub fn render(report: &FullReport) -> String {
    let body: String = report.suites.iter().enumerate().map(|(k, suite)| section(suite, k)).collect();
    format!(
        "<!doctype html>\n<html lang=\"en\">\n<head>\n<meta charset=\"utf-8\">\n\
         <meta name=\"viewport\" content=\"width=device-width, initial-scale=1\">\n\
         <meta name=\"color-scheme\" content=\"light dark\">\n<link rel=\"icon\" href=\"data:,\">\n<title>Wayfix report</title>\n\
         <style>\n:root{{{LIGHT_PALETTE}{light};{LIGHT_VERDICTS}}}\n@media (prefers-color-scheme: dark){{:root{{{DARK_PALETTE}{dark};{DARK_VERDICTS}}}}}\n\
         {STYLE}</style>\n</head>\n<body>\n{header}<main>\n{body}</main>\n<script>\n{SCRIPT}</script>\n</body>\n</html>\n",
        header = overview::header(report),
        light = named_palette(false),
        dark = named_palette(true),
    )
}

const STYLE: &str = include_str!("page.css");
const SCRIPT: &str = include_str!("page.js");
const LIGHT_VERDICTS: &str = "--pass:#1b7a43;--fail:#b3261e;--fail-wash:#fbeae8";
const DARK_VERDICTS: &str = "--pass:#63cb95;--fail:#ff8a80;--fail-wash:#3a1d1b";

fn section(suite: &ReportSuite, k: usize) -> String {
    let name = escape(&suite.name);
    let runs: String =
        suite.runs.iter().enumerate().map(|(n, run)| run::article(run, &anchor(k, Some(n)))).collect();
    let comparison = overview::comparison(suite, k);
    format!("<section id=\"{}\">\n<h2>{name}</h2>\n{comparison}{runs}</section>\n", anchor(k, None))
}

/// The fragment of suite `k` or of its run `n`.
fn anchor(k: usize, n: Option<usize>) -> String {
    n.map_or_else(|| format!("suite-{k}"), |n| format!("suite-{k}-run-{n}"))
}

/// A table in a scrollable box; each head is a text and whether its column is numeric.
fn table(label: &str, heads: &[(&str, bool)], rows: &str) -> String {
    let head = |(text, numeric): &(&str, bool)| {
        let class = if *numeric { " class=\"number\"" } else { "" };
        format!("<th scope=\"col\"{class}><button type=\"button\">{}</button></th>", escape(text))
    };
    let heads: String = heads.iter().map(head).collect();
    format!(
        "<div class=\"scroll\" tabindex=\"0\" role=\"region\" aria-label=\"{}\"><table>\n<thead><tr>{heads}</tr></thead>\n\
         <tbody>\n{rows}</tbody></table></div>\n",
        escape(label)
    )
}

/// A cell with a number; it sorts by the number itself, not by its digits on the page.
fn number_cell(value: Option<f64>) -> String {
    let text = super::number::significant_or_empty(value).replace('-', "−");
    match value.filter(|value| value.is_finite()) {
        Some(value) => format!("<td class=\"number\" data-value=\"{value}\">{text}</td>"),
        None => format!("<td class=\"number\">{text}</td>"),
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::plot::{LinePlot, PlotSeries};
    use crate::report::{Metric, ReportRun};

    fn hostile() -> FullReport {
        let evil = "</script><script>alert(\"1\")</script>&<img src=x onerror='x'>";
        let plot = LinePlot {
            title: evil.to_owned(),
            series: vec![PlotSeries::new(evil, vec![(0.0, 1.0), (1.0, 2.0)])],
            ..Default::default()
        };
        let run = ReportRun {
            name: evil.to_owned(),
            metrics: vec![Metric::new(evil, f64::NAN, evil).at_most(1.0).peer(evil, 2.0).bound_from(evil)],
            events: [(evil.to_owned(), 1)].into(),
            figures: vec![plot.draw().unwrap()],
            notes: vec![evil.to_owned()],
            log: Some("javascript:alert(1)\" onclick=\"x".to_owned()),
            layout: Some("javascript:alert(1)\" onclick=\"x".to_owned()),
            error: Some(evil.to_owned()),
            ..ReportRun::default()
        };
        let suite = ReportSuite { name: evil.to_owned(), runs: vec![run.clone(), run] };
        FullReport { suites: vec![suite], commit: Some(evil.to_owned()), ..FullReport::default() }
    }

    #[test]
    fn no_text_becomes_markup() {
        let page = render(&hostile());
        assert_eq!(page.matches("<script").count(), 1);
        assert_eq!(page.matches("<img").count(), 0);
        assert!(!page.contains("href=\"javascript:") && !page.contains("onclick=\"x"));
    }

    #[test]
    fn nothing_is_fetched() {
        let page = render(&hostile()).replace("http://www.w3.org/2000/svg", "");
        for outside in ["http://", "https://", "src=\"", "@import", "url("] {
            assert!(!page.contains(outside), "{outside}");
        }
    }

    #[test]
    fn every_picture_has_a_size_and_a_text() {
        let page = render(&hostile());
        let pictures: Vec<&str> =
            page.split("<svg ").skip(1).filter_map(|rest| rest.split('>').next()).collect();
        assert_eq!(pictures.len(), 2);
        for picture in pictures {
            for attribute in ["width=\"", "height=\"", "role=\"img\"", "aria-label=\""] {
                assert!(picture.contains(attribute), "{attribute} in {picture}");
            }
        }
    }
}
