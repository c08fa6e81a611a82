//! Files of tests that no module declares: they would never be compiled.

use super::{Finding, Source};

const ROOT: &str = "/tests/integration/";

pub(super) fn check(sources: &[Source]) -> Vec<Finding> {
    let tests = sources.iter().filter(|source| source.path.contains(ROOT) && source.path.ends_with(".rs"));
    let undeclared = tests.filter(|source| {
        parent(&source.path).is_some_and(|(parents, name)| {
            let is_declared = |text: &str| text.lines().any(|line| declares(line, name));
            !sources.iter().any(|other| parents.contains(&other.path) && is_declared(&other.text))
        })
    });
    undeclared.map(|source| Finding::new(&source.path, 0, "no module declares it", "it never runs")).collect()
}

/// The files that may declare a module, and its name; nothing for the file that all begins with.
fn parent(path: &str) -> Option<([String; 2], &str)> {
    let module = path.strip_suffix("/mod.rs").or_else(|| path.strip_suffix(".rs"))?;
    let (folder, name) = module.rsplit_once('/')?;
    (name != "main").then(|| ([format!("{folder}/main.rs"), format!("{folder}/mod.rs")], name))
}

fn declares(line: &str, name: &str) -> bool {
    let declared = line.strip_suffix(';').and_then(|line| line.rsplit_once("mod "));
    declared.is_some_and(|(_, declared)| declared == name)
}

#[cfg(test)]
mod tests {
    use super::super::source;
    use super::*;

    #[test]
    fn undeclared_test_file_is_found() {
        let at = |path: &str, text: &str| source(&format!("crates/a/tests/integration/{path}"), text);
        let tree = [
            at("main.rs", "//! Tests.\n\nmod b;\n#[cfg(feature = \"x\")]\nmod c;\n"),
            at("b.rs", ""),
            at("c/mod.rs", "pub(crate) mod d;\n"),
            at("c/d.rs", ""),
            at("c/b.rs", ""),
        ];
        let found: Vec<_> = check(&tree).into_iter().map(|finding| finding.path).collect();
        assert_eq!(found, ["crates/a/tests/integration/c/b.rs"]);
    }
}
