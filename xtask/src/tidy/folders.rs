//! Limits on the number of files in a folder and in a crate.

use std::collections::BTreeMap;

use super::{Finding, Source};

const MOST_FILES: usize = 15;
const MOST_LINES: usize = 10_000;
/// Crates that may be larger: worlds for four systems.
const LARGER: [(&str, usize); 1] = [("crates/scene-sim", 11_000)];

pub(super) fn check(sources: &[Source]) -> Vec<Finding> {
    let rust = || sources.iter().filter(|source| source.path.ends_with(".rs"));
    let mut files: BTreeMap<&str, usize> = BTreeMap::new();
    let mut lines: BTreeMap<&str, usize> = BTreeMap::new();
    for source in rust() {
        let (folder, _) = source.path.rsplit_once('/').unwrap_or_default();
        *files.entry(folder).or_default() += 1;
        if let Some((krate, _)) = source.path.split_once("/src/") {
            *lines.entry(krate).or_default() += source.text.lines().count();
        }
    }
    let crowded = files.into_iter().filter(|(_, n)| *n > MOST_FILES).map(|(folder, n)| {
        let what = format!("{n} files, more than {MOST_FILES}");
        Finding::new(folder, 0, what, "a folder of its own for what belongs together")
    });
    let large = lines.into_iter().filter_map(|(krate, n)| {
        let limit =
            LARGER.iter().find(|(larger, _)| *larger == krate).map_or(MOST_LINES, |(_, limit)| *limit);
        let what = format!("{n} lines in src, more than {limit}");
        (n > limit).then(|| Finding::new(krate, 0, what, "a crate of its own for what can stand alone"))
    });
    crowded.chain(large).collect()
}

#[cfg(test)]
mod tests {
    use super::super::source;
    use super::*;

    #[test]
    fn crowded_folder_and_large_crate_are_found() {
        let files =
            |n: usize| (0..n).map(|i| source(&format!("crates/a/src/x/{i}.rs"), "")).collect::<Vec<_>>();
        assert!(check(&files(15)).is_empty());
        assert_eq!(check(&files(16))[0].path, "crates/a/src/x");
        let large = |n: usize| {
            [source("crates/a/src/lib.rs", &"x\n".repeat(n)), source("crates/a/tests/x.rs", "x\n")]
        };
        assert!(check(&large(10_000)).is_empty());
        assert_eq!(check(&large(10_001))[0].path, "crates/a");
    }
}
