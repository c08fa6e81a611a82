//! The dependency diagram in `docs/architecture.md`, drawn from the output of Cargo.

use std::collections::{BTreeMap, BTreeSet};
use std::fmt::Write as _;

use super::{Finding, Source};

/// The page with the picture.
pub(super) const PAGE: &str = "docs/architecture.md";
/// Lines around the picture.
const MARKS: [&str; 2] =
    ["<!-- dependencies: written by `cargo xtask tidy --write` -->\n```text\n", "```\n<!-- end -->\n"];

/// Arguments of `cargo tree` for [`picture`].
pub(super) const TREE: [&str; 11] = [
    "tree",
    "--locked",
    "--workspace",
    "--all-features",
    "-e",
    "normal",
    "--depth",
    "1",
    "--prefix",
    "depth",
    "--no-dedupe",
];

type Graph<'a> = BTreeMap<&'a str, BTreeSet<&'a str>>;

/// A finding if the page does not contain the diagram of `tree`.
pub(super) fn check(sources: &[Source], tree: &str) -> Vec<Finding> {
    let page = sources.iter().find(|source| source.path == PAGE);
    let is_drawn = page.is_some_and(|page| with_picture(&page.text, tree).as_deref() == Some(&page.text));
    let finding = || {
        let what = "the dependency picture is missing or stale";
        Finding::new(PAGE, 0, what, "`cargo xtask tidy --write` draws it from what Cargo resolves")
    };
    if is_drawn { Vec::new() } else { vec![finding()] }
}

/// The page with the diagram of `tree` between its markers; `None` if a marker is missing.
pub(super) fn with_picture(page: &str, tree: &str) -> Option<String> {
    let (before, rest) = page.split_once(MARKS[0])?;
    let (_, after) = rest.split_once(MARKS[1])?;
    Some(format!("{before}{}{}{}{after}", MARKS[0], picture(tree), MARKS[1]))
}

/// One line per crate with its direct dependencies in the workspace, without transitive ones; lowest first.
fn picture(tree: &str) -> String {
    let graph = graph(tree);
    let mut crates: Vec<&str> = graph.keys().copied().collect();
    crates.sort_by_key(|name| (height(&graph, name), *name));
    let width = crates.iter().map(|name| name.len()).max().unwrap_or(0);
    crates.iter().fold(String::new(), |mut text, name| {
        let direct = &graph[name];
        let is_brought = |other: &&str| direct.iter().any(|via| reached(&graph, via).contains(*other));
        let shown: Vec<&str> = direct.iter().filter(|other| !is_brought(other)).copied().collect();
        let line = format!("{name:width$}  ─►  {}", shown.join(", "));
        let line = if shown.is_empty() { *name } else { &line };
        let _ = writeln!(text, "{line}");
        text
    })
}

/// Direct dependencies among the members of the workspace.
fn graph(tree: &str) -> Graph<'_> {
    let mut graph = Graph::new();
    let mut member = None;
    for line in tree.lines() {
        let Some(depth) = line.chars().next().and_then(|digit| digit.to_digit(10)) else { continue };
        let name = line[1..].split(' ').next().unwrap_or_default();
        let name =
            name.strip_prefix("wayfix-").or(Some(name).filter(|name| *name == "wayfix" || *name == "xtask"));
        match (depth, name, member) {
            (0, name, _) => {
                member = name;
                graph.extend(name.map(|name| (name, BTreeSet::new())));
            }
            (_, Some(other), Some(member)) => drop(graph.entry(member).or_default().insert(other)),
            _ => {}
        }
    }
    graph
}

/// Everything below a crate.
fn reached<'a>(graph: &Graph<'a>, name: &str) -> BTreeSet<&'a str> {
    let direct = graph.get(name).into_iter().flatten();
    direct.flat_map(|other| std::iter::once(*other).chain(reached(graph, other))).collect()
}

/// Number of crates on the longest dependency path.
fn height(graph: &Graph<'_>, name: &str) -> usize {
    graph.get(name).into_iter().flatten().map(|other| 1 + height(graph, other)).max().unwrap_or(0)
}

#[cfg(test)]
mod tests {
    use super::super::source;
    use super::*;

    const TREE: &str = "0wayfix-traits v0.1.0 (x)\n1libm v0.2.1\n\n0wayfix-core v0.1.0 (x)\n1wayfix-traits v0.1.0 (x)\n\n0wayfix v0.1.0 (x)\n1wayfix-core v0.1.0 (x)\n1wayfix-traits v0.1.0 (x)\n";

    #[test]
    fn picture_leaves_out_what_another_dependency_brings() {
        assert_eq!(picture(TREE), "traits\ncore    ─►  traits\nwayfix  ─►  core\n");
    }

    #[test]
    fn stale_picture_is_found_and_the_drawn_one_is_not() {
        let page = format!("a\n{}old\n{}b\n", MARKS[0], MARKS[1]);
        assert_eq!(check(&[source(PAGE, &page)], TREE).len(), 1);
        let drawn = with_picture(&page, TREE).unwrap();
        assert!(check(&[source(PAGE, &drawn)], TREE).is_empty());
        assert!(drawn.starts_with("a\n") && drawn.ends_with("b\n"));
    }

    #[test]
    fn page_without_marks_is_found() {
        assert_eq!(check(&[source(PAGE, "a\n")], TREE).len(), 1);
    }
}
