use std::fs;
use std::path::{Path, PathBuf};

use crate::LogError;

/// What a recorder of ROS 2 writes beside the files of a bag when it ends as it should.
const METADATA: &str = "metadata.yaml";

/// The files to read: a recorder of ROS 2 makes a folder for each bag, with a file, or several where it splits them.
pub(crate) fn files_of(path: &Path) -> Result<Vec<PathBuf>, LogError> {
    if !path.is_dir() {
        return Ok(vec![path.into()]);
    }
    let files = files_in(path)?;
    let named = named_in_metadata(path, &files);
    match files.len() {
        0 => Err(LogError::IsADirectory { path: path.into() }),
        1 => Ok(files),
        _ if !named.is_empty() => Ok(named),
        _ if are_parts(&files) => Ok(files),
        _ => Err(LogError::SeveralFiles { path: path.into(), files }),
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

/// Those of the files that the folder's metadata lists, each on a line of its own.
fn named_in_metadata(folder: &Path, files: &[PathBuf]) -> Vec<PathBuf> {
    let Ok(text) = fs::read_to_string(folder.join(METADATA)) else { return Vec::new() };
    let items = text.lines().filter_map(|line| line.trim().strip_prefix("- "));
    let names: Vec<&str> = items.map(|item| item.trim().trim_matches(['"', '\''])).collect();
    let is_named = |file: &&PathBuf| names.iter().any(|name| file.file_name() == Some(name.as_ref()));
    files.iter().filter(is_named).cloned().collect()
}

/// Whether all names are one name with numbers behind it.
fn are_parts(files: &[PathBuf]) -> bool {
    let name = |file: &PathBuf| {
        let stem = file.file_stem()?.to_str()?;
        let (name, number) = stem.rsplit_once('_')?;
        (!number.is_empty() && number.bytes().all(|byte| byte.is_ascii_digit())).then(|| name.to_owned())
    };
    let mut names = files.iter().map(name);
    let Some(Some(first)) = names.next() else { return false };
    names.all(|name| name.as_ref() == Some(&first))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn parts_are_one_name_with_numbers() {
        let are = |names: &[&str]| are_parts(&names.iter().map(PathBuf::from).collect::<Vec<_>>());
        assert!(are(&["drive_0.mcap", "drive_1.mcap", "drive_10.mcap"]));
        assert!(are(&["rosbag2_2026_11_21-10_00_00_0.mcap", "rosbag2_2026_11_21-10_00_00_1.mcap"]));
        assert!(!are(&["drive_0.mcap", "walk_1.mcap"]));
        assert!(!are(&["drive.mcap", "drive_1.mcap"]));
        assert!(!are(&["drive_dark.mcap", "drive_bright.mcap"]));
    }
}
