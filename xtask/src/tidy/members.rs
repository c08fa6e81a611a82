//! Every crate has a description and uses the workspace's lints.

use super::manifest::{member, value};
use super::{Finding, Source};

pub(super) fn check(sources: &[Source]) -> Vec<Finding> {
    let mut findings = Vec::new();
    for manifest in sources.iter().filter(|source| member(&source.path).is_some()) {
        let mut missing = |what: &str, why| findings.push(Finding::new(&manifest.path, 0, what, why));
        if value(&manifest.text, "lints", "workspace") != Some("true") {
            missing("no `[lints] workspace = true`", "lints are written once, in the workspace");
        }
        if value(&manifest.text, "package", "description").is_none_or(str::is_empty) {
            missing("no description", "the registry and the crate table show it");
        }
        if value(&manifest.text, "package", "rust-version") != Some("true") {
            missing("no `rust-version.workspace = true`", "the minimum Rust version is stated once");
        }
        findings.extend(undocumented_roots(sources, manifest));
    }
    findings
}

fn undocumented_roots(sources: &[Source], manifest: &Source) -> Vec<Finding> {
    let folder = manifest.path.trim_end_matches("Cargo.toml");
    let is_root =
        |source: &&Source| matches!(source.path.strip_prefix(folder), Some("src/lib.rs" | "src/main.rs"));
    sources
        .iter()
        .filter(is_root)
        .filter(|source| !source.text.trim_start().starts_with("//!"))
        .map(|source| Finding::new(&source.path, 1, "no `//!` documentation", "a crate says what it is for"))
        .collect()
}

#[cfg(test)]
mod tests {
    use super::super::source;
    use super::*;

    const GOOD: &str =
        "[package]\ndescription = \"d\"\nrust-version.workspace = true\n[lints]\nworkspace = true\n";

    #[test]
    fn a_complete_crate_passes_and_each_gap_is_found() {
        let lib = source("crates/a/src/lib.rs", "//! What it is.\n");
        assert!(check(&[source("crates/a/Cargo.toml", GOOD), lib]).is_empty());
        for gap in ["description = \"d\"\n", "rust-version.workspace = true\n", "[lints]\nworkspace = true\n"]
        {
            assert_eq!(check(&[source("crates/a/Cargo.toml", &GOOD.replace(gap, ""))]).len(), 1, "{gap}");
        }
        let bare = source("crates/a/src/lib.rs", "mod b;\n");
        assert_eq!(check(&[source("crates/a/Cargo.toml", GOOD), bare]).len(), 1);
    }
}
