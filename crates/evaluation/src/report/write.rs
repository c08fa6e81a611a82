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
            replace_file(&path, text).map_err(refused(&path))?;
        }
        Ok(())
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
