//! The stated minimum Rust version is at least that of every dependency, and stated once.

use super::manifest::value;
use super::{Finding, Source};

/// `metadata` is the output of `cargo metadata --format-version 1`.
pub(super) fn check(sources: &[Source], metadata: &str) -> Vec<Finding> {
    let text_of =
        |path: &str| sources.iter().find(|source| source.path == path).map_or("", |s| s.text.as_str());
    let Some(stated) = value(text_of("Cargo.toml"), "workspace.package", "rust-version") else {
        return vec![Finding::new(
            "Cargo.toml",
            0,
            "no rust-version",
            "users must know which compiler will do",
        )];
    };
    let mut findings = Vec::new();
    for (package, needed) in rust_versions(metadata) {
        if number(needed) > number(stated) {
            let what = format!("rust-version {stated}, but {package} needs {needed}");
            findings.push(Finding::new("Cargo.toml", 0, what, "the stated minimum must be true"));
        }
    }
    if let Some(lint) = value(text_of("clippy.toml"), "", "msrv").filter(|lint| *lint != stated) {
        let what = format!("msrv {lint} differs from rust-version {stated}");
        findings.push(Finding::new("clippy.toml", 0, what, "lints must judge by the version that is stated"));
    }
    findings
}

/// Package and `rust_version` of every package that states one.
///
/// A scan instead of a JSON reader keeps this program's build at a few seconds. In each package's object the
/// path of the manifest comes before the Rust version; quotes inside strings are escaped, so keys are found safely.
fn rust_versions(metadata: &str) -> Vec<(&str, &str)> {
    let mut versions = Vec::new();
    for package in metadata.split("\"manifest_path\":\"").skip(1) {
        let folder = package.split("/Cargo.toml\"").next().unwrap_or_default();
        let name = folder.rsplit('/').next().unwrap_or_default();
        if let Some((_, rest)) = package.split_once("\"rust_version\":\"") {
            versions.push((name, rest.split('"').next().unwrap_or_default()));
        }
    }
    versions
}

/// `1.89` and `1.89.0` are the same version.
fn number(version: &str) -> [u32; 3] {
    let mut parts = version.split('.').map(|part| part.parse().unwrap_or(0));
    std::array::from_fn(|_| parts.next().unwrap_or(0))
}

#[cfg(test)]
mod tests {
    use super::super::source;
    use super::*;

    const METADATA: &str = r#"{"packages":[{"name":"a","manifest_path":"/r/a-1.0.0/Cargo.toml","rust_version":"1.70.0"},
        {"name":"b","manifest_path":"/r/b-2.0.0/Cargo.toml","rust_version":null},
        {"name":"c","manifest_path":"/r/c-3.1.0/Cargo.toml","rust_version":"1.89"}]}"#;

    fn workspace(version: &str) -> Source {
        source("Cargo.toml", &format!("[workspace.package]\nrust-version = \"{version}\" # why\n"))
    }

    #[test]
    fn version_below_a_dependency_is_found_by_name() {
        assert!(check(&[workspace("1.89")], METADATA).is_empty());
        let findings = check(&[workspace("1.88")], METADATA);
        assert_eq!(findings.len(), 1);
        assert!(findings[0].what.contains("c-3.1.0 needs 1.89"), "{}", findings[0]);
        assert_eq!(check(&[workspace("1.9")], METADATA).len(), 2, "versions are numbers, not text");
    }

    #[test]
    fn a_second_opinion_in_clippy_toml_is_found() {
        assert_eq!(
            check(&[workspace("1.89"), source("clippy.toml", "msrv = \"1.80\"\n")], METADATA).len(),
            1
        );
    }
}
