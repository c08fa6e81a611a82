//! Words that make a text hard to read: personification, inversion, a diary's tone, private words.

use super::super::{Finding, Source};

/// Words to avoid, in lower case, with replacements. In two halves, so that this file does not match itself.
const WORDS: [(&str, &str); 14] = [
    (concat!("who", "ever"), "name the subject: the robot, the filter, the caller"),
    (concat!("ous", "ted"), "previous hypothesis"),
    (concat!("the usual", " sins"), "realistic error sources, by name"),
    (concat!("has no", " meaning"), "say what is refused: `OutOfRange` if …"),
    (concat!("have no", " meaning"), "say what is refused: `OutOfRange` if …"),
    (concat!("without", " meaning"), "invalid"),
    (concat!("earlier", " build"), "a guide tells what is, an ADR what was tried"),
    (concat!("tried and", " dropped"), "a guide tells what is, an ADR what was tried"),
    (concat!("just", " so"), "the figure and the target"),
    (concat!("led", "_away"), "diverged after relocalization"),
    (concat!("said", "_lost"), "reported lost"),
    (concat!("per_", "metre"), "per_meter"),
    (concat!("never", "_twice"), "one detection per landmark"),
    (concat!("last", "_look"), "keyframe"),
];
/// Files that list old names beside the new ones.
const OLD_NAMES: [&str; 2] = ["CHANGELOG.md", "crates/wayfix/src/cli/parameter_file/renamed.rs"];

pub(in crate::tidy) fn check(sources: &[Source]) -> Vec<Finding> {
    let is_checked =
        |path: &str| (path.ends_with(".rs") || path.ends_with(".md")) && !OLD_NAMES.contains(&path);
    let checked = sources.iter().filter(|source| is_checked(&source.path));
    checked
        .flat_map(|source| source.text.lines().enumerate().flat_map(move |line| in_line(source, line)))
        .collect()
}

fn in_line<'a>(source: &'a Source, (index, line): (usize, &str)) -> impl Iterator<Item = Finding> + use<'a> {
    let line = line.to_lowercase();
    // The words of a name.
    let names = line.replace('_', " ");
    WORDS
        .iter()
        .filter(move |(word, _)| is_word(&line, word) || is_word(&names, word))
        .map(move |(word, instead)| Finding::new(&source.path, index + 1, format!("`{word}`"), instead))
}

/// Whether `line` contains `word`, not as a part of a longer word.
fn is_word(line: &str, word: &str) -> bool {
    line.match_indices(word).any(|(start, _)| {
        let before = line[..start].chars().next_back();
        let after = line[start + word.len()..].chars().next();
        ![before, after].into_iter().flatten().any(char::is_alphanumeric)
    })
}

#[cfg(test)]
mod tests {
    use super::super::super::source;
    use super::*;

    #[test]
    fn listed_word_is_found_with_its_line() {
        let text = format!("fine\nFor {} is lost.\n", WORDS[0].0);
        let findings = check(&[source("docs/x.md", &text)]);
        assert_eq!(findings.iter().map(|finding| finding.line).collect::<Vec<_>>(), [2]);
    }

    #[test]
    fn listed_words_are_found_in_a_name() {
        let text = format!("fn angle_{}_is_refused() {{}}\n", WORDS[5].0.replace(' ', "_"));
        assert_eq!(check(&[source("crates/x/src/lib.rs", &text)]).len(), 1);
    }

    #[test]
    fn part_of_a_longer_word_is_passed_over() {
        let longer = format!("un{}x\n", WORDS[1].0);
        assert!(check(&[source("docs/x.md", &longer)]).is_empty());
    }
}
