use std::io;
use std::path::{Path, PathBuf};

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
        let refused = |path: &Path| {
            let path = path.to_owned();
            |source| ReportError::Io { path, source }
        };
        std::fs::create_dir_all(folder).map_err(refused(folder))?;
        let json = serde_json::to_string_pretty(self)? + "\n";
        for (name, text) in [("report.json", json), ("index.html", html::render(self))] {
            let path = folder.join(name);
            std::fs::write(&path, text).map_err(refused(&path))?;
        }
        Ok(())
    }
}
