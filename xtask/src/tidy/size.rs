//! Small files, light fixtures, and few crates behind the ones a robot takes alone.

use std::collections::BTreeSet;

use super::{Finding, Source};

const LONG: usize = 300;
const TOO_LONG: usize = 400;
const TOO_HEAVY: u64 = 3_000_000;
const TOO_MANY: usize = 20;

/// Rust files that are over the limit.
pub(super) fn lengths(sources: &[Source]) -> Vec<Finding> {
    longer_than(sources, TOO_LONG)
}

/// Rust files that are getting there.
pub(super) fn long(sources: &[Source]) -> Vec<Finding> {
    let mut findings = longer_than(sources, LONG);
    let refused = lengths(sources);
    findings.retain(|finding| !refused.contains(finding));
    findings
}

fn longer_than(sources: &[Source], limit: usize) -> Vec<Finding> {
    let rust = sources.iter().filter(|source| source.path.ends_with(".rs"));
    rust.map(|source| (source, source.text.lines().count()))
        .filter(|(_, lines)| *lines > limit)
        .map(|(source, lines)| {
            Finding::new(&source.path, 0, format!("{lines} lines"), "one idea, one file: split it")
        })
        .collect()
}

/// Files too heavy for a clone.
pub(super) fn weights(files: &[(String, u64)]) -> Vec<Finding> {
    let heavy = files.iter().filter(|(_, bytes)| *bytes > TOO_HEAVY);
    heavy
        .map(|(path, bytes)| {
            let what = format!("{:.1} MB", *bytes as f64 / 1e6);
            Finding::new(
                path,
                0,
                what,
                "fixtures stay below 3 MB: shorten the log or compute it from its seed",
            )
        })
        .collect()
}

/// A finding for too many linked crates (without macros, which run at compile time) in the output of `cargo tree --prefix none` for `package`.
pub(super) fn tree(package: &str, listing: &str) -> Vec<Finding> {
    // A crate that came before is listed again with a star.
    let crates: BTreeSet<_> =
        listing.lines().map(|line| line.trim_end_matches(" (*)")).filter(|l| !l.is_empty()).collect();
    if crates.len() <= TOO_MANY {
        return Vec::new();
    }
    let what = format!("`cargo tree -p {package} -e normal,no-proc-macro` lists {} crates", crates.len());
    vec![Finding::new(
        "Cargo.lock",
        0,
        what,
        "a robot that wants one crate must not compile the others (20 at most)",
    )]
}

#[cfg(test)]
mod tests {
    use super::super::source;
    use super::*;

    #[test]
    fn long_files_are_warned_of_and_longer_ones_refused() {
        let sources = [300, 301, 400, 401].map(|n| source(&format!("{n}.rs"), &"x\n".repeat(n)));
        let paths = |findings: Vec<Finding>| findings.into_iter().map(|f| f.path).collect::<Vec<_>>();
        assert_eq!(paths(long(&sources)), ["301.rs", "400.rs"]);
        assert_eq!(paths(lengths(&sources)), ["401.rs"]);
        assert!(lengths(&[source("data.txt", &"x\n".repeat(9999))]).is_empty());
    }

    #[test]
    fn heavy_files_are_found() {
        let files = [("a.mcap".to_owned(), 3_000_000), ("b.mcap".to_owned(), 3_000_001)];
        assert_eq!(weights(&files).len(), 1);
    }

    #[test]
    fn a_crate_counts_once() {
        let listing = |n: usize| (0..n).map(|i| format!("c{i} v1.0.0\nc0 v1.0.0 (*)\n")).collect::<String>();
        assert!(tree("p", &listing(20)).is_empty());
        assert_eq!(tree("p", &listing(21)).len(), 1);
    }
}
