//! Names that a reader can take in: functions and tests of at most sixty characters.

use super::{Finding, Source};

const TOO_LONG: usize = 60;

pub(super) fn check(sources: &[Source]) -> Vec<Finding> {
    let is_checked = |path: &str| path.ends_with(".rs");
    sources.iter().filter(|source| is_checked(&source.path)).flat_map(long_names).collect()
}

fn long_names(source: &Source) -> impl Iterator<Item = Finding> {
    source.text.lines().enumerate().filter_map(|(index, line)| {
        let name = function(line).filter(|name| name.len() > TOO_LONG)?;
        let what = format!("`{name}` has {} characters, more than {TOO_LONG}", name.len());
        Some(Finding::new(&source.path, index + 1, what, "a test's name says subject, condition, outcome"))
    })
}

/// The name of the function that a line defines.
fn function(line: &str) -> Option<&str> {
    let (before, after) = line.split_once("fn ")?;
    let is_definition = before
        .split_whitespace()
        .all(|word| matches!(word, "pub" | "async" | "const" | "pub(crate)" | "pub(super)"));
    let end = after.find(|c: char| !(c.is_ascii_alphanumeric() || c == '_')).unwrap_or(after.len());
    is_definition.then_some(&after[..end])
}

#[cfg(test)]
mod tests {
    use super::super::source;
    use super::*;

    #[test]
    fn name_over_sixty_characters_is_found_with_its_line() {
        let text = format!("    fn {}() {{}}\n    fn {}() {{}}\n", "a".repeat(60), "b".repeat(61));
        let findings = check(&[source("crates/kalman/tests/x.rs", &text)]);
        assert_eq!(findings.iter().map(|finding| finding.line).collect::<Vec<_>>(), [2]);
    }

    #[test]
    fn files_of_other_languages_are_passed_over() {
        let text = format!("fn {}() {{}}\n", "b".repeat(61));
        assert!(check(&[source("docs/x.md", &text)]).is_empty());
    }
}
