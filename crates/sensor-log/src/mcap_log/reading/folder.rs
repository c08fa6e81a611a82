use std::collections::BTreeSet;
use std::fs;
use std::path::{Path, PathBuf};

use crate::{LogError, LogWarning};

/// Metadata file that a ROS 2 recorder writes beside the files of a bag on a regular end.
const METADATA: &str = "metadata.yaml";

/// The files to read, with warnings: a ROS 2 recorder creates a folder for each bag, with one file, or several if it splits them.
pub(crate) fn files_of(path: &Path) -> Result<(Vec<PathBuf>, Vec<LogWarning>), LogError> {
    if !path.is_dir() {
        return Ok((vec![path.into()], Vec::new()));
    }
    let files = files_in(path)?;
    let names = names_in_metadata(path);
    let is_named = |file: &&PathBuf| names.iter().any(|name| file.file_name() == Some(name.as_ref()));
    let named: Vec<PathBuf> = files.iter().filter(is_named).cloned().collect();
    let files = match files.len() {
        0 => return Err(LogError::IsADirectory { path: path.into() }),
        1 => files,
        _ if are_parts(&files) => files,
        _ if !named.is_empty() => named.clone(),
        _ => return Err(LogError::SeveralFiles { path: path.into(), files }),
    };
    let mut warnings = Vec::new();
    let mut warn = |name, text| warnings.push(LogWarning { name, text });
    if !named.is_empty() && named.len() < files.len() {
        let text = format!("{METADATA} names {} of the {} parts: all are read", named.len(), files.len());
        warn("metadata_is_stale", text);
    }
    let is_there = |name: &&String| files.iter().any(|file| file.file_name() == Some(name.as_ref()));
    let mut missing: Vec<String> = names.iter().filter(|name| !is_there(name)).cloned().collect();
    missing.extend(missing_numbers(&files));
    if !missing.is_empty() {
        warn(
            "bag_part_missing",
            format!("the recording lacks {}: transforms and records of it are lost", missing.join(", ")),
        );
    }
    Ok((files, warnings))
}

/// Everything in the folder that is called MCAP, by name.
pub(crate) fn files_in(folder: &Path) -> Result<Vec<PathBuf>, LogError> {
    let io = |source| LogError::io(folder, source);
    let mut files = Vec::new();
    for entry in fs::read_dir(folder).map_err(io)? {
        let path = entry.map_err(io)?.path();
        let is_hidden = path.file_name().is_some_and(|name| name.to_string_lossy().starts_with('.'));
        if !is_hidden && path.extension().is_some_and(|extension| extension.eq_ignore_ascii_case("mcap")) {
            files.push(path);
        }
    }
    files.sort();
    Ok(files)
}

/// The files listed in the folder's metadata, one per line.
fn names_in_metadata(folder: &Path) -> Vec<String> {
    let Ok(text) = fs::read_to_string(folder.join(METADATA)) else { return Vec::new() };
    let items = text.lines().filter_map(|line| line.trim().strip_prefix("- "));
    let names = items.map(|item| item.trim().trim_matches(['"', '\'']).to_owned());
    names.filter(|name| name.ends_with(".mcap")).collect()
}

/// Parts of a recording that is numbered from 0 which are not there, up to the last that is.
fn missing_numbers(files: &[PathBuf]) -> Vec<String> {
    if files.len() < 2 || !are_parts(files) {
        return Vec::new();
    }
    let number = |file: &PathBuf| file.file_stem()?.to_str()?.rsplit_once('_')?.1.parse::<u64>().ok();
    let present: BTreeSet<u64> = files.iter().filter_map(number).collect();
    let last = present.last().copied().unwrap_or(0).min(10_000);
    (0..last).filter(|number| !present.contains(number)).map(|number| format!("part {number}")).collect()
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
