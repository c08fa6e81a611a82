//! Pages that a reader finishes: guides, decisions, all of them together.

use super::super::{Finding, Source};

const GUIDE: usize = 1200;
const COMPARISON: usize = 1500;
const DECISION: usize = 500;
const TOGETHER: usize = 22_000;
/// Pages of tables that compare with other programs.
const COMPARISONS: [&str; 3] = ["docs/accuracy.md", "docs/performance.md", "CHANGELOG.md"];

pub(in crate::tidy) fn check(sources: &[Source]) -> Vec<Finding> {
    let pages = sources.iter().filter(|source| source.path.ends_with(".md"));
    let counted: Vec<(&str, usize)> = pages.map(|page| (page.path.as_str(), n_words(&page.text))).collect();
    let mut findings: Vec<Finding> = counted.iter().filter_map(|(path, n)| too_long(path, *n)).collect();
    // That of a crate says what its manifest says, for the registry.
    let is_of_crate = |path: &str| path.starts_with("crates/") && path.ends_with("/README.md");
    let together: usize = counted.iter().filter(|(path, _)| !is_of_crate(path)).map(|(_, n)| n).sum();
    if together > TOGETHER {
        let what = format!("all pages have {together} words, more than {TOGETHER}");
        findings.push(Finding::new(
            "docs",
            0,
            what,
            "a record goes into an ADR, a detail into the docs of its type",
        ));
    }
    findings
}

fn too_long(path: &str, n: usize) -> Option<Finding> {
    let limit = match path {
        _ if path.starts_with("docs/adr/") => DECISION,
        _ if COMPARISONS.contains(&path) => COMPARISON,
        _ => GUIDE,
    };
    let what = format!("{n} words, more than {limit}");
    (n > limit)
        .then(|| Finding::new(path, 0, what, "a guide tells what is; what was tried is a record (docs/adr)"))
}

/// Tables and recordings that are generated, or that only list names: they are looked up, not read, and the limits are for what is read.
const NOT_COUNTED: [(&str, &str); 6] = [
    ("<!-- figures: ", "<!-- end figures -->"),
    ("<!-- long runs -->", "<!-- end long runs -->"),
    ("<!-- names -->", "<!-- end names -->"),
    ("<!-- papers -->", "<!-- end papers -->"),
    ("<!-- peers -->", "<!-- end peers -->"),
    ("<!-- transcript -->", "<!-- end transcript -->"),
];

/// Words, without tables of figures and of names.
fn n_words(text: &str) -> usize {
    let mut counted = text.to_owned();
    for (begin, end) in NOT_COUNTED {
        while let Some((before, rest)) = counted.split_once(begin) {
            let after = rest.split_once(end).map_or("", |(_, after)| after);
            counted = format!("{before}{after}");
        }
    }
    counted.split_whitespace().count()
}

#[cfg(test)]
mod tests {
    use super::super::super::source;
    use super::*;

    fn page(path: &str, n: usize) -> Source {
        source(path, &"word ".repeat(n))
    }

    #[test]
    fn each_kind_of_page_has_its_limit() {
        let paths =
            |pages: &[Source]| check(pages).into_iter().map(|finding| finding.path).collect::<Vec<_>>();
        assert!(paths(&[page("docs/slam.md", 1200), page("docs/adr/0001-x.md", 500)]).is_empty());
        assert_eq!(paths(&[page("docs/slam.md", 1201)]), ["docs/slam.md"]);
        assert_eq!(paths(&[page("docs/adr/0001-x.md", 501)]), ["docs/adr/0001-x.md"]);
        let many: Vec<Source> = (0..20).map(|i| page(&format!("docs/{i}.md"), 1101)).collect();
        assert_eq!(paths(&many), ["docs"]);
    }

    #[test]
    fn generated_tables_are_not_counted() {
        assert_eq!(n_words("a b\n<!-- figures: slam -->\n| x | y |\n<!-- end figures -->\nc"), 3);
    }
}
