//! Relative links in Markdown and named source files have targets, and the changelog has a section for unreleased changes.

use std::collections::BTreeSet;
use std::ops::Range;

use super::super::{Finding, Source};

pub(in crate::tidy) fn check(sources: &[Source], paths: &[String]) -> Vec<Finding> {
    let known = with_folders(paths);
    let mut findings = Vec::new();
    for source in sources.iter().filter(|source| source.path.ends_with(".md")) {
        for (line, target) in links(&source.text) {
            if !known.contains(&resolve(&source.path, target)) {
                findings.push(Finding::new(
                    &source.path,
                    line,
                    format!("link to `{target}`"),
                    "there is no such file",
                ));
            }
        }
        for (line, file) in source_files(&source.text) {
            if source.path.starts_with("docs/") && !known.contains(&format!("crates/{file}")) {
                findings.push(Finding::new(
                    &source.path,
                    line,
                    format!("`{file}`"),
                    "there is no such file below crates",
                ));
            }
        }
    }
    match sources.iter().find(|source| source.path == "CHANGELOG.md") {
        Some(changelog) if changelog.text.lines().any(|line| line.starts_with("## [Unreleased]")) => {}
        _ => findings.push(Finding::new(
            "CHANGELOG.md",
            0,
            "no `## [Unreleased]`",
            "changes are written down as they land",
        )),
    }
    findings
}

/// Line and path of every source file that is named in code spans, as `crate/src/file.rs`.
fn source_files(text: &str) -> impl Iterator<Item = (usize, &str)> {
    text.lines().enumerate().flat_map(|(index, line)| {
        let spans = line.split('`').skip(1).step_by(2);
        spans
            .filter(|span| span.contains("/src/") && span.ends_with(".rs"))
            .map(move |span| (index + 1, span))
    })
}

/// Line and file of every relative link outside of code; the part after `#` is dropped.
fn links(text: &str) -> Vec<(usize, &str)> {
    let line_of = |at: usize| text[..at].matches('\n').count() + 1;
    let files = link_targets(text).into_iter().map(|target| {
        let line = line_of(target.start);
        (line, text[target].split('#').next().unwrap_or_default())
    });
    files.filter(|(_, file)| !file.is_empty() && !file.contains(':')).collect()
}

/// Ranges of the link targets in a Markdown text, without those in code.
pub(crate) fn link_targets(text: &str) -> Vec<Range<usize>> {
    let mut targets = Vec::new();
    let (mut fenced, mut offset) = (false, 0);
    for line in text.split_inclusive('\n') {
        fenced ^= line.trim_start().starts_with("```");
        // Code spans are every second piece between back-ticks.
        let prose_links = |(start, _): &(usize, &str)| line[..*start].matches('`').count() % 2 == 0;
        for (start, opening) in line.match_indices("](").filter(prose_links).filter(|_| !fenced) {
            let start = start + opening.len();
            let target = line[start..].split([')', ' ', '\n']).next().unwrap_or_default();
            targets.push(offset + start..offset + start + target.len());
        }
        offset += line.len();
    }
    targets
}

/// The path of a relative link in the file `from`.
pub(crate) fn resolve(from: &str, target: &str) -> String {
    let mut parts: Vec<&str> = from.split('/').collect();
    parts.pop();
    for part in target.split('/') {
        match part {
            "" | "." => {}
            ".." => {
                parts.pop();
            }
            name => parts.push(name),
        }
    }
    parts.join("/")
}

fn with_folders(paths: &[String]) -> BTreeSet<String> {
    let mut known = BTreeSet::new();
    for path in paths {
        let ends = path.match_indices('/').map(|(end, _)| end);
        known.extend(ends.chain([path.len()]).map(|end| path[..end].to_owned()));
    }
    known
}

#[cfg(test)]
mod tests {
    use super::super::super::source;
    use super::*;

    fn complaints(path: &str, text: &str) -> Vec<String> {
        let tree = ["README.md", "docs/architecture.md", "docs/adr/0001-record.md"].map(str::to_owned);
        let changelog = source("CHANGELOG.md", "## [Unreleased]\n");
        check(&[source(path, text), changelog], &tree).iter().map(ToString::to_string).collect()
    }

    #[test]
    fn links_that_lead_somewhere_pass() {
        let text = "[a](docs/architecture.md#x) [b](docs/adr/) [c](https://example.org) [d](#here)\n\
                    ```\n[e](nowhere)\n```\nand `[f](nowhere)`\n";
        assert!(complaints("README.md", text).is_empty());
        assert!(
            complaints("docs/architecture.md", "[up](../README.md) [adr](adr/0001-record.md)").is_empty()
        );
    }

    #[test]
    fn links_that_lead_nowhere_are_found_with_their_line() {
        let found = complaints("docs/architecture.md", "text\n[readme](README.md)\n");
        assert_eq!(found, ["docs/architecture.md:2: link to `README.md`: there is no such file"]);
    }

    #[test]
    fn source_files_that_are_gone_are_found() {
        let text = "passes `README.md` and\n`kalman/src/gone.rs`\n";
        let found = complaints("docs/architecture.md", text);
        assert_eq!(
            found,
            ["docs/architecture.md:2: `kalman/src/gone.rs`: there is no such file below crates"]
        );
    }

    #[test]
    fn a_changelog_without_unreleased_is_found() {
        assert_eq!(check(&[source("CHANGELOG.md", "## [0.1.0]\n")], &[]).len(), 1);
        assert_eq!(check(&[], &[]).len(), 1);
    }
}
