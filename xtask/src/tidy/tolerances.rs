//! Two-sided tolerances in tests: `approx` compares them, and shows both values where they differ.

use super::code::without_comments_and_strings;
use super::{Finding, Source};

/// Programs that users read, and the localizer whose tests still compare by hand.
const PASSED_OVER: [&str; 2] = ["/examples/", "crates/color-model/"];

pub(super) fn check(sources: &[Source]) -> Vec<Finding> {
    let is_checked =
        |path: &str| path.ends_with(".rs") && !PASSED_OVER.iter().any(|part| path.contains(part));
    sources.iter().filter(|source| is_checked(&source.path)).flat_map(by_hand).collect()
}

/// Assertions that begin with `(a - b).abs() <`.
fn by_hand(source: &Source) -> Vec<Finding> {
    let code = without_comments_and_strings(&source.text);
    let compares = |(at, opening): (usize, &str)| {
        let rest = code[at + opening.len()..].trim_start().strip_prefix('(')?;
        let end = closing(rest)?;
        let is_difference = rest[..end].contains(" - ") && rest[end + 1..].starts_with(".abs() <");
        let what = "the tolerance of a difference is compared by hand";
        let line = code[..at].lines().count();
        is_difference.then(|| Finding::new(&source.path, line, what, "`approx::assert_abs_diff_eq!`"))
    };
    code.match_indices("assert!(").filter_map(compares).collect()
}

/// Where the parenthesis closes that is open before `text`.
fn closing(text: &str) -> Option<usize> {
    let mut depth = 1;
    text.find(|c: char| {
        depth += i32::from(c == '(') - i32::from(c == ')');
        depth == 0
    })
}

#[cfg(test)]
mod tests {
    use super::super::source;
    use super::*;

    #[test]
    fn compared_difference_is_found_and_one_sided_bound_is_not() {
        let text = "\n assert!((a - f(b)).abs() < 1e-9);\n assert!(\n (a - b).abs() <= t,\n \"x\");\n assert!(error.abs() < 0.1);\n";
        let lines =
            |path| check(&[source(path, text)]).iter().map(|finding| finding.line).collect::<Vec<_>>();
        assert_eq!(lines("crates/kalman/tests/x.rs"), [2, 3]);
        assert!(lines("crates/kalman/examples/x.rs").is_empty());
        assert!(
            by_hand(&source("x.rs", "assert!((a - b).norm() < 2.0); // assert!((a - b).abs() < 1.0)"))
                .is_empty()
        );
    }
}
