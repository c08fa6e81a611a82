//! Rust text with comments, strings and test modules blanked.
//!
//! Line numbers are unchanged, so findings can refer to them.

/// Code only: replaces comments and the content of literals by spaces.
pub(super) fn without_comments_and_strings(text: &str) -> String {
    let chars: Vec<char> = text.chars().collect();
    let mut kept = chars.clone();
    let mut at = 0;
    while at < chars.len() {
        let end = match chars[at] {
            '/' if chars.get(at + 1) == Some(&'/') => line_end(&chars, at),
            '/' if chars.get(at + 1) == Some(&'*') => comment_end(&chars, at),
            '"' => string_end(&chars, at),
            'r' if !follows_word(&chars, at) => raw_string_end(&chars, at).unwrap_or(at),
            '\'' => char_end(&chars, at).unwrap_or(at),
            _ => at,
        };
        blank(&mut kept[at..end]);
        at = end.max(at + 1);
    }
    kept.into_iter().collect()
}

/// Blanks every item under `#[cfg(test)]` or `#[cfg(doctest)]`; expects text without comments and strings.
pub(super) fn without_tests(code: &str) -> String {
    let mut chars: Vec<char> = code.chars().collect();
    for attribute in ["#[cfg(test)]", "#[cfg(doctest)]"] {
        let pattern: Vec<char> = attribute.chars().collect();
        while let Some(start) = chars.windows(pattern.len()).position(|window| window == pattern) {
            let end = item_end(&chars, start + pattern.len());
            blank(&mut chars[start..end]);
        }
    }
    chars.into_iter().collect()
}

/// Whether `line` contains `word` with no letter, digit or underscore next to it.
pub(super) fn has_word(line: &str, word: &str) -> bool {
    let part_of_word = |c: char| c.is_alphanumeric() || c == '_';
    line.match_indices(word).any(|(start, _)| {
        let before = line[..start].chars().next_back();
        let after = line[start + word.len()..].chars().next();
        let open_start = !word.starts_with(part_of_word);
        let open_end = !word.ends_with(part_of_word);
        (open_start || !before.is_some_and(part_of_word)) && (open_end || !after.is_some_and(part_of_word))
    })
}

fn blank(chars: &mut [char]) {
    for c in chars.iter_mut().filter(|c| **c != '\n') {
        *c = ' ';
    }
}

/// Whether the `r` at `at` ends or continues a name; the `b` of `br"…"` does not count.
fn follows_word(chars: &[char], at: usize) -> bool {
    let is_word = |c: &char| c.is_alphanumeric() || *c == '_';
    let mut before = chars[..at].iter().rev().peekable();
    before.next_if_eq(&&'b');
    before.next().is_some_and(is_word)
}

fn line_end(chars: &[char], start: usize) -> usize {
    chars[start..].iter().position(|c| *c == '\n').map_or(chars.len(), |length| start + length)
}

fn comment_end(chars: &[char], start: usize) -> usize {
    let (mut depth, mut at) = (0, start);
    while at + 1 < chars.len() {
        match (chars[at], chars[at + 1]) {
            ('/', '*') => depth += 1,
            ('*', '/') => depth -= 1,
            _ => {
                at += 1;
                continue;
            }
        }
        at += 2;
        if depth == 0 {
            return at;
        }
    }
    chars.len()
}

fn string_end(chars: &[char], start: usize) -> usize {
    let mut at = start + 1;
    while at < chars.len() {
        match chars[at] {
            '\\' => at += 2,
            '"' => return at + 1,
            _ => at += 1,
        }
    }
    chars.len()
}

fn raw_string_end(chars: &[char], start: usize) -> Option<usize> {
    let hashes = chars[start + 1..].iter().take_while(|c| **c == '#').count();
    let open = start + 1 + hashes;
    if chars.get(open) != Some(&'"') {
        return None;
    }
    let closes = |at: &usize| {
        chars[*at] == '"' && chars[at + 1..].iter().take(hashes).filter(|c| **c == '#').count() == hashes
    };
    Some((open + 1..chars.len()).find(closes).map_or(chars.len(), |quote| quote + 1 + hashes))
}

/// The end of a character literal, or `None` for a lifetime.
fn char_end(chars: &[char], start: usize) -> Option<usize> {
    if chars.get(start + 1) == Some(&'\\') {
        let rest = chars.get(start + 3..)?;
        return rest.iter().position(|c| *c == '\'').map(|length| start + 4 + length);
    }
    (chars.get(start + 2) == Some(&'\'')).then_some(start + 3)
}

/// The end of the item that begins after `start`: a semicolon or the closing brace, whichever counts.
fn item_end(chars: &[char], start: usize) -> usize {
    let mut depth = 0;
    for (at, c) in chars.iter().enumerate().skip(start) {
        match c {
            '{' => depth += 1,
            '}' => {
                depth -= 1;
                if depth == 0 {
                    return at + 1;
                }
            }
            ';' if depth == 0 => return at + 1,
            _ => {}
        }
    }
    chars.len()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn comments_and_literals_go_and_code_stays() {
        let text =
            "a(\"x // \\\" y\"); // z\nlet c = '\"'; let d: &'static str = r#\"q\"w\"#; /* e /* f */ g */ h";
        let code = without_comments_and_strings(text);
        assert_eq!(code.lines().count(), 2);
        let words: Vec<_> = code.split_whitespace().collect();
        assert_eq!(words, ["a(", ");", "let", "c", "=", ";", "let", "d:", "&'static", "str", "=", ";", "h"]);
    }

    #[test]
    fn escaped_quotes_do_not_swallow_what_follows() {
        assert!(without_comments_and_strings(r"let q = '\''; unsafe {}").contains("unsafe"));
        assert!(without_comments_and_strings(r#"let b = b"\\"; unsafe {}"#).contains("unsafe"));
        assert!(without_comments_and_strings(r#"let b = br"\"; unsafe {}"#).contains("unsafe"));
    }

    #[test]
    fn test_modules_go_with_all_their_braces() {
        let code =
            without_tests("a;\n#[cfg(test)]\nmod tests { fn f() { g() } }\nb;\n#[cfg(test)]\nmod more;\nc;");
        assert_eq!(code.split_whitespace().collect::<String>(), "a;b;c;");
    }

    #[test]
    fn words_are_whole() {
        assert!(has_word("let x: Instant;", "Instant"));
        assert!(!has_word("Instantaneous", "Instant"));
        assert!(has_word("::std::fs::read", "std::fs"));
        assert!(!has_word("std::fsync", "std::fs"));
    }
}
