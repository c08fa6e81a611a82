//! Files of the tree: everything that git tracks or would track.

use anyhow::Result;

use super::Source;
use crate::shell;

/// Paths from the root, with slashes; new files that are not ignored count.
pub(crate) fn tracked() -> Result<Vec<String>> {
    let list = ["ls-files", "--cached", "--others", "--exclude-standard"];
    let listing = shell::output(&mut shell::command("git", &list))?;
    let exists = |path: &&str| shell::root().join(path).is_file();
    Ok(listing.lines().filter(exists).map(str::to_owned).collect())
}

/// Those of `paths` that are text.
pub(super) fn read(paths: &[String]) -> Result<Vec<Source>> {
    let mut sources = Vec::new();
    for path in paths {
        if let Ok(text) = String::from_utf8(std::fs::read(shell::root().join(path))?) {
            sources.push(Source { path: path.clone(), text });
        }
    }
    Ok(sources)
}

/// Bytes of each file.
pub(super) fn weights(paths: &[String]) -> Vec<(String, u64)> {
    let bytes = |path: &String| shell::root().join(path).metadata().map_or(0, |metadata| metadata.len());
    paths.iter().map(|path| (path.clone(), bytes(path))).collect()
}
