use serde_json::{Value, json};

use super::super::source;
use super::*;

const TABLE_TEXT: &str = r#"
[[paper]]
key = "Ann 2004"
title = "On gains"
equations = 1
tables = 1
figures = 1
rows = [
  { item = "Eq. 1", what = "gain", run = "wayfix run slam" },
  { item = "Table 1, dark", what = "rates", published = "0.9, 0.8", ours = "one, two", measured = ["slam/loop/rate", "slam/loop/other"] },
  { item = "Fig. 1", what = "photo", published = "picture", missing = "a photograph" },
]
"#;
const CODE: &str = "/// The gain. [Ann 2004, Eq. 1]\n/// [Ann 2004, Table 1]\n";
const PLAN: &str = "[[run]]\nname = \"loop\"\n";

fn tree(code: &str, table: &str, page: &str) -> Vec<Source> {
    vec![
        source("crates/a/src/b/c.rs", code),
        source(TABLE, table),
        source("fixtures/slam.toml", PLAN),
        source(PAGE, page),
    ]
}

fn written(before: &str, report: &Value) -> String {
    let sources = tree(CODE, TABLE_TEXT, before);
    page::page(&table::read(TABLE_TEXT).unwrap(), &sources, &Measured::new(before, report))
}

fn findings(code: &str, table: &str) -> Vec<String> {
    let page = written("", &Value::Null);
    check(&tree(code, table, &page)).iter().map(ToString::to_string).collect()
}

#[test]
fn page_has_a_row_for_each_item() {
    let page = written("", &Value::Null);
    let link = "[a/b/c](../crates/a/src/b/c.rs)";
    assert!(
        page.contains(&format!("| Eq. 1 | gain | {link} | `wayfix run slam` | formula | as printed |\n")),
        "{page}"
    );
    let row = format!(
        "| Table 1, dark | rates | {link} | `cargo xtask regress slam`: loop | 0.9, 0.8 | one, two: not in the last report |"
    );
    assert!(page.contains(&row), "{page}");
    assert!(page.contains("| Fig. 1 | photo | none | none | picture | a photograph |\n"), "{page}");
}

#[test]
fn measured_figures_stay_until_a_report_has_them() {
    let report = |metrics: Value| json!({"suites": [{"name": "slam", "runs": [{"name": "loop", "metrics": metrics}]}]});
    let first = report(
        json!([{"name": "rate", "value": 0.5, "unit": ""}, {"name": "other", "value": 0.25, "unit": "m"}]),
    );
    let page = written("", &first);
    assert!(page.contains("| 0.9, 0.8 | one, two: 0.5, 0.25 m |\n"), "{page}");
    assert_eq!(written(&page, &Value::Null), page);
    let second = report(json!([{"name": "rate", "value": 0.75, "unit": "", "pass": false}]));
    assert!(written(&page, &second).contains("| one, two: 0.75 (missed), 0.25 m |\n"));
    let papers = table::read(TABLE_TEXT).unwrap();
    assert!(Measured::new("", &second).check(&papers).is_err(), "the run lost a figure");
}

#[test]
fn marks_and_rows_must_agree() {
    assert!(findings(CODE, TABLE_TEXT).is_empty());
    let more = format!("{CODE}/// [Ann 2004, Eq. 2]\n");
    assert!(findings(&more, TABLE_TEXT)[0].starts_with("crates/a/src/b/c.rs:3: Eq. 2"));
    let less = findings("/// [Ann 2004, Eq. 1]\n", TABLE_TEXT);
    assert!(less[0].contains("Table 1, dark: no mark") && less[1].contains("stale"), "{less:?}");
    let no_command = findings(CODE, &TABLE_TEXT.replace(", run = \"wayfix run slam\"", ""));
    assert!(no_command[0].contains("Eq. 1: no command"), "{no_command:?}");
    let no_run = findings(CODE, &TABLE_TEXT.replace("slam/loop/other", "slam/lap/other"));
    assert!(no_run[0].contains("slam/lap/other"), "{no_run:?}");
}
