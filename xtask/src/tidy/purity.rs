//! Libraries must not use files, clocks, the terminal or their own randomness, and `unsafe` is forbidden everywhere.

use super::code::{has_word, without_comments_and_strings, without_tests};
use super::{Finding, Source};

/// Crates that access the outside world; all others under `crates` are pure computation.
const OUTWARD: [&str; 8] = [
    "sensor-log",
    "table-log",
    "evaluation",
    "system-core",
    "slam-system",
    "systems",
    "experiments",
    "wayfix",
];

const OUTSIDE: [&str; 11] = [
    "std::fs",
    "std::io",
    "std::env",
    "std::net",
    "std::process",
    "println!",
    "eprintln!",
    "print!",
    "eprint!",
    "SystemTime",
    "Instant",
];
const RANDOM: [&str; 6] = ["thread_rng", "ThreadRng", "rand::rng", "rand::random", "from_os_rng", "OsRng"];

/// Readers and writers of bytes that take any `Read` or `Write`, and open nothing.
const STREAMS: [&str; 2] = ["crates/smoother/src/g2o/", "crates/encoded-image/src/"];

const WHY_OUTSIDE: &str = "only sensor-log, table-log, evaluation, the systems, experiments, wayfix and xtask touch files, clocks or the terminal";
const WHY_RANDOM: &str = "no crate creates randomness; take `rng: &mut R` as the last argument";
const WHY_UNSAFE: &str = "unsafe code is forbidden in every crate";

pub(super) fn check(sources: &[Source]) -> Vec<Finding> {
    let mut findings = Vec::new();
    for source in sources.iter().filter(|source| source.path.ends_with(".rs")) {
        let code = without_comments_and_strings(&source.text);
        findings.extend(words(source, &code, &["unsafe"], WHY_UNSAFE));
        let Some(owner) = library_code(&source.path) else { continue };
        let code = without_tests(&code);
        findings.extend(words(source, &code, &RANDOM, WHY_RANDOM));
        if !OUTWARD.contains(&owner) {
            let streams = STREAMS.iter().any(|folder| source.path.starts_with(folder));
            let outside: Vec<_> =
                OUTSIDE.into_iter().filter(|word| !(streams && *word == "std::io")).collect();
            findings.extend(words(source, &code, &outside, WHY_OUTSIDE));
            findings.extend(grouped_imports(source, &code, streams));
        }
    }
    findings
}

/// The crate folder if `path` is library code: in its `src`, and not a test module.
fn library_code(path: &str) -> Option<&str> {
    let (owner, inside) = path.strip_prefix("crates/")?.split_once("/src/")?;
    let test_file = inside.split('/').any(|part| part == "tests" || part == "tests.rs");
    (!owner.contains('/') && !test_file).then_some(owner)
}

fn words(source: &Source, code: &str, forbidden: &[&str], why: &'static str) -> Vec<Finding> {
    let mut findings = Vec::new();
    for (index, line) in code.lines().enumerate() {
        for word in forbidden.iter().filter(|word| has_word(line, word)) {
            findings.push(Finding::new(&source.path, index + 1, format!("`{word}`"), why));
        }
    }
    findings
}

/// `use std::{fs, …}` hides the paths in [`words`].
fn grouped_imports(source: &Source, code: &str, streams: bool) -> Vec<Finding> {
    let mut findings = Vec::new();
    for (start, _) in code.match_indices("std::{") {
        let line = code[..start].lines().count().max(1);
        let group = code[start..].split(';').next().unwrap_or_default();
        let modules =
            ["fs", "io", "env", "net", "process"].iter().filter(|module| !(streams && **module == "io"));
        for module in modules.filter(|module| has_word(group, module)) {
            findings.push(Finding::new(&source.path, line, format!("`std::{{{module}}}`"), WHY_OUTSIDE));
        }
    }
    findings
}

#[cfg(test)]
mod tests {
    use super::super::source;
    use super::*;

    fn lines(path: &str, text: &str) -> Vec<usize> {
        check(&[source(path, text)]).iter().map(|finding| finding.line).collect()
    }

    #[test]
    fn an_estimator_that_reads_a_file_a_clock_or_dice_is_found() {
        let path = "crates/kalman/src/ekf.rs";
        assert_eq!(lines(path, "fn a() {\n    std::fs::read(p);\n}"), [2]);
        assert_eq!(lines(path, "use std::{\n    fmt,\n    fs,\n};"), [1]);
        assert_eq!(lines(path, "let now = Instant::now();"), [1]);
        assert_eq!(lines(path, "let mut rng = rand::rng();"), [1]);
        assert_eq!(lines(path, "eprintln!(\"lost\");"), [1]);
    }

    #[test]
    fn talking_about_it_or_testing_with_it_is_fine() {
        let path = "crates/kalman/src/ekf.rs";
        assert!(lines(path, "// unlike std::fs\nlet s = \"println!\";\nuse std::{fmt, iter};").is_empty());
        assert!(lines(path, "#[cfg(test)]\nmod tests { fn f() { println!(); } }").is_empty());
        assert!(lines("crates/kalman/examples/a.rs", "println!();").is_empty());
        assert!(lines("crates/kalman/peers/src/main.rs", "println!();").is_empty());
    }

    #[test]
    fn the_outward_crates_may_read_files_but_not_roll_dice() {
        assert!(lines("crates/sensor-log/src/open.rs", "std::fs::read(p);").is_empty());
        assert_eq!(lines("crates/wayfix/src/run.rs", "rand::random()"), [1]);
    }

    #[test]
    fn graph_files_may_be_streams_but_not_be_opened() {
        let path = "crates/smoother/src/g2o/read.rs";
        assert!(
            lines(path, "use std::{\n    collections::HashMap,\n    io::BufRead,\n};\nuse std::io::Write;")
                .is_empty()
        );
        assert_eq!(lines(path, "std::fs::read(p);"), [1]);
        assert_eq!(lines("crates/smoother/src/laws.rs", "use std::io::Write;"), [1]);
    }

    #[test]
    fn unsafe_is_found_even_in_tests() {
        assert_eq!(lines("xtask/src/main.rs", "#[cfg(test)]\nmod tests { fn f() { unsafe {} } }"), [2]);
    }
}
