//! Leftovers: notes without an issue, debug prints, paths of one machine.

use super::super::code::{has_word, without_comments_and_strings};
use super::super::{Finding, Source};

// In two halves, so that this file does not find itself.
const NOTES: [&str; 2] = [concat!("TO", "DO"), concat!("FIX", "ME")];
const MACHINE_PATHS: [&str; 4] =
    [concat!("/wo", "rk/"), concat!("/ho", "me/"), concat!("/ro", "ot/"), concat!("/Us", "ers/")];

pub(in crate::tidy) fn check(sources: &[Source]) -> Vec<Finding> {
    let mut findings = Vec::new();
    for source in sources {
        let rust = source.path.ends_with(".rs");
        let code = if rust { without_comments_and_strings(&source.text) } else { String::new() };
        for (index, line) in source.text.lines().enumerate() {
            let mut found =
                |what: String, why| findings.push(Finding::new(&source.path, index + 1, what, why));
            if rust
                && let Some(note) = NOTES.iter().find(|note| has_word(line, note) && !has_issue(line, note))
            {
                found(
                    format!("`{note}` without an issue"),
                    "write `NOTE(#12)` with the number, or do it now",
                );
            }
            if let Some(path) = MACHINE_PATHS.iter().find(|path| is_absolute(line, path)) {
                found(format!("absolute path `{path}…`"), "it exists on one machine only");
            }
        }
        for (index, line) in code.lines().enumerate().filter(|(_, line)| has_word(line, "dbg!")) {
            findings.push(Finding::new(&source.path, index + 1, line.trim(), "a debug print"));
        }
    }
    findings
}

fn has_issue(line: &str, note: &str) -> bool {
    line.split(note).skip(1).all(|rest| {
        rest.strip_prefix("(#").is_some_and(|number| number.starts_with(|c: char| c.is_ascii_digit()))
    })
}

/// `path` as the beginning of a path, not in the middle of a longer one or of an address.
fn is_absolute(line: &str, path: &str) -> bool {
    line.match_indices(path).any(|(start, _)| {
        let before = line[..start].chars().next_back();
        !before.is_some_and(|c| c.is_alphanumeric() || "._-/~}$*".contains(c))
    })
}

#[cfg(test)]
mod tests {
    use super::super::super::source;
    use super::*;

    fn count(path: &str, text: &str) -> usize {
        check(&[source(path, text)]).len()
    }

    #[test]
    fn notes_need_an_issue() {
        assert_eq!(count("a.rs", &format!("// {}: later\n", NOTES[0])), 1);
        assert_eq!(count("a.rs", &format!("// {}(#12): later\n", NOTES[1])), 0);
        assert_eq!(count("a.rs", "// a todo list\n"), 0);
    }

    #[test]
    fn debug_prints_count_in_code_only() {
        assert_eq!(count("a.rs", "let x = dbg!(y);"), 1);
        assert_eq!(count("a.rs", "// no dbg! here"), 0);
    }

    #[test]
    fn machine_paths_are_found_in_any_file() {
        let home = MACHINE_PATHS[1];
        assert_eq!(count("README.md", &format!("run {home}ann/wayfix")), 1);
        assert_eq!(count("README.md", &format!("see https://example.org{home}page and ..{home}x")), 0);
    }
}
