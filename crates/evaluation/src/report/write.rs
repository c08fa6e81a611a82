use std::io;
use std::path::{Path, PathBuf};

use serde_json::Value;

use super::{FullReport, html};

/// Errors of writing a report.
#[derive(Debug, thiserror::Error)]
#[non_exhaustive]
pub enum ReportError {
    /// An error of the file system.
    #[error("cannot write {}: {source}", path.display())]
    Io {
        /// Which file or folder.
        path: PathBuf,
        /// The reason.
        source: io::Error,
    },
    /// A number or name has no JSON form.
    #[error("cannot express the report as JSON: {0}")]
    Json(#[from] serde_json::Error),
}

impl FullReport {
    /// Writes `report.json` and `index.html` to `folder`, which is created if missing.
    /// # Errors
    /// Returns an error if the folder or a file cannot be written.
    pub fn write(&self, folder: &Path) -> Result<(), ReportError> {
        self.write_json(folder, serde_json::to_string_pretty(self)?)
    }

    /// As [`write`](Self::write), for runs of a user's own log, which nothing judges: `report.json` is without commit, bounds and verdicts.
    /// # Errors
    /// Returns an error if the folder or a file cannot be written.
    pub fn write_unjudged(&self, folder: &Path) -> Result<(), ReportError> {
        let mut json = serde_json::to_value(self)?;
        remove_judgement(&mut json);
        self.write_json(folder, serde_json::to_string_pretty(&json)?)
    }

    fn write_json(&self, folder: &Path, json: String) -> Result<(), ReportError> {
        let refused = |path: &Path| {
            let path = path.to_owned();
            |source| ReportError::Io { path, source }
        };
        std::fs::create_dir_all(folder).map_err(refused(folder))?;
        let json = json + "\n";
        for (name, text) in [("report.json", json), ("index.html", html::render(self))] {
            let path = folder.join(name);
            replace_file(&path, text).map_err(refused(&path))?;
        }
        Ok(())
    }
}

/// Removes what only a judged run has, at any depth but in the counts of events.
fn remove_judgement(json: &mut Value) {
    match json {
        Value::Object(fields) => {
            fields.retain(|name, _| !["commit", "low", "high", "paper", "pass"].contains(&name.as_str()));
            fields
                .iter_mut()
                .filter(|(name, _)| *name != "events")
                .for_each(|(_, value)| remove_judgement(value));
        }
        Value::Array(values) => values.iter_mut().for_each(remove_judgement),
        _ => {}
    }
}

/// Writes a file beside `path` and puts it in its place: a reader never sees half of it.
/// # Errors
/// Returns the error of the file system.
pub fn replace_file(path: &Path, content: impl AsRef<[u8]>) -> io::Result<()> {
    let mut unfinished = path.as_os_str().to_owned();
    unfinished.push(".tmp");
    std::fs::write(&unfinished, content)?;
    std::fs::rename(unfinished, path)
}

#[cfg(test)]
mod tests {
    use super::super::{Metric, ReportRun, ReportSuite};
    use super::*;

    #[test]
    fn unjudged_report_has_figures_only_and_reads_back() {
        let metrics = vec![Metric::new("ate_rmse_m", 0.25, "m")];
        let run = ReportRun { name: "drive".to_owned(), metrics, ..ReportRun::default() };
        let run = ReportRun { events: [("pass".to_owned(), 3)].into(), ..run };
        let suites = vec![ReportSuite { name: "slam".to_owned(), runs: vec![run] }];
        let report = FullReport { suites, ..FullReport::default() };
        let mut json = serde_json::to_value(&report).unwrap();
        remove_judgement(&mut json);
        let run = &json["suites"][0]["runs"][0];
        assert_eq!(run["metrics"], serde_json::json!([{"name": "ate_rmse_m", "value": 0.25, "unit": "m"}]));
        assert_eq!((json.get("commit"), &run["events"]["pass"]), (None, &3.into()));
        assert_eq!(serde_json::from_value::<FullReport>(json).unwrap(), report);
    }
}
