use std::fs;
use std::path::{Path, PathBuf};

use crate::LogError;

/// The file to read: a recorder of ROS 2 makes a folder for each bag.
pub(crate) fn file_of(path: &Path) -> Result<PathBuf, LogError> {
    if !path.is_dir() {
        return Ok(path.into());
    }
    let mut files = files_in(path)?;
    match (files.pop(), files.is_empty()) {
        (Some(file), true) => Ok(file),
        (None, _) => Err(LogError::IsADirectory { path: path.into() }),
        (Some(last), false) => {
            files.push(last);
            Err(LogError::SeveralFiles { path: path.into(), files })
        }
    }
}

/// Everything in the folder that is called MCAP, by name.
pub(crate) fn files_in(folder: &Path) -> Result<Vec<PathBuf>, LogError> {
    let io = |source| LogError::io(folder, source);
    let mut files = Vec::new();
    for entry in fs::read_dir(folder).map_err(io)? {
        let path = entry.map_err(io)?.path();
        if path.extension().is_some_and(|extension| extension.eq_ignore_ascii_case("mcap")) {
            files.push(path);
        }
    }
    files.sort();
    Ok(files)
}
