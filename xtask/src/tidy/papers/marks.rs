//! Marks in the code, such as `[Schulz & Fox 2004, Eq. 9]`.

use super::super::{Finding, Source};
use super::item::{Item, items};

/// An item of a paper that a file implements or shows.
pub(super) struct Mark<'a> {
    pub(super) path: &'a str,
    pub(super) line: usize,
    pub(super) item: Item,
}

/// The marks of the paper with this key.
pub(super) fn marks<'a>(sources: &'a [Source], key: &str) -> Vec<Mark<'a>> {
    let opening = format!("[{key},");
    let mut found = Vec::new();
    for source in rust(sources) {
        for (at, _) in source.text.match_indices(&opening) {
            let rest = &source.text[at + opening.len()..];
            let content = rest.split(']').next().unwrap_or_default();
            let line = source.text[..at].matches('\n').count() + 1;
            found.extend(items(&one_line(content)).into_iter().map(|item| Mark {
                path: &source.path,
                line,
                item,
            }));
        }
    }
    found
}

/// Comments that name one of the authors by another key, or an item without its paper.
pub(super) fn misspelled(sources: &[Source], keys: &[&str]) -> Vec<Finding> {
    let mut findings = Vec::new();
    for source in rust(sources) {
        for (index, line) in source.text.lines().enumerate() {
            let Some(comment) = line.trim_start().strip_prefix("//") else { continue };
            let mut found = |what: &str, why| findings.push(Finding::new(&source.path, index + 1, what, why));
            for key in keys {
                let author = format!("[{}", key.split(' ').next().unwrap_or_default());
                let is_other = |at: usize| !comment[at + 1..].starts_with(key);
                if comment.match_indices(&author).any(|(at, _)| is_other(at)) {
                    found(&author, "one key a paper, as in docs/papers.toml");
                }
            }
            if ["[Eq. ", "[Eqs. ", "[Fig. ", "[Figs. ", "[Table "].iter().any(|item| comment.contains(item)) {
                found("an item without its paper", "write `[KEY, Eq. 9]`");
            }
        }
    }
    findings
}

fn rust(sources: &[Source]) -> impl Iterator<Item = &Source> {
    sources.iter().filter(|source| source.path.starts_with("crates/") && source.path.ends_with(".rs"))
}

/// A mark that goes on in the next line of a comment, in one line.
fn one_line(content: &str) -> String {
    let lines = content.lines().map(|line| line.trim_start().trim_start_matches(['/', '!']).trim());
    lines.collect::<Vec<_>>().join(" ")
}

#[cfg(test)]
mod tests {
    use super::super::super::source;
    use super::*;

    #[test]
    fn marks_are_found_over_the_end_of_a_line() {
        let text =
            "/// A gain. [Ann 2004, Eqs. 3–4]\nfn a() {}\n/// Bob. [Ann 2004,\n/// Fig. 7; Bob 1999]\n";
        let sources = [source("crates/a/src/lib.rs", text), source("docs/a.md", "[Ann 2004, Eq. 1]")];
        let found: Vec<_> =
            marks(&sources, "Ann 2004").iter().map(|mark| format!("{} {}", mark.line, mark.item)).collect();
        assert_eq!(found, ["1 Eq. 3", "1 Eq. 4", "3 Fig. 7"]);
    }

    #[test]
    fn other_keys_and_items_without_a_paper_are_found() {
        let text = "/// [Ann 2004, Eq. 1]\n/// [Ann 2003]\n/// as in [Eq. 2]\nlet key = \"[Ann 2003]\";\n";
        let lines: Vec<_> = misspelled(&[source("crates/a/src/lib.rs", text)], &["Ann 2004"])
            .iter()
            .map(|finding| finding.line)
            .collect();
        assert_eq!(lines, [2, 3]);
    }
}
