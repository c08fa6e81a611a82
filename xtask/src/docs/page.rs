//! Path of a Markdown file of the repository in the site, and the targets of its links.

use std::path::Path;

use crate::tidy::{link_targets, resolve};

/// Folder of the book with the files of the repository that its pages name.
const FILES: &str = "files";

pub(super) struct Page {
    /// Path in the repository.
    pub(super) source: String,
    /// Path in the book.
    pub(super) target: String,
}

impl Page {
    /// `docs/README.md` is the index; other pages keep their path relative to `docs`.
    pub(super) fn of(path: &str) -> Option<Self> {
        let stem = match path {
            "docs/README.md" => "index",
            "CHANGELOG.md" => "changelog",
            "peers/README.md" => "peers",
            _ => path.strip_prefix("docs/")?.strip_suffix(".md")?,
        };
        Some(Self { source: path.to_owned(), target: format!("{stem}.html") })
    }

    /// Relative path to the root of the book.
    pub(super) fn up(&self) -> String {
        "../".repeat(self.target.matches('/').count())
    }

    /// Banner at the top of every page.
    pub(super) fn banner(&self) -> String {
        let up = self.up();
        format!(
            "<header><a href=\"{up}index.html\">Wayfix</a> <a href=\"{up}architecture.html\">Architecture</a> \
             <a href=\"{up}../wayfix/index.html\">API reference</a> <a href=\"{up}changelog.html\">Changes</a></header>\n"
        )
    }

    /// Files of the repository that the text names and that are no page or picture: each path and its copy in the book.
    pub(super) fn files(&self, text: &str, tracked: &[String]) -> Vec<(String, String)> {
        let named = link_targets(text).into_iter().filter_map(|target| match self.target(&text[target]) {
            Target::File(path) => Some(path),
            Target::Site(_) => None,
        });
        let below = |path: &str| format!("{path}/");
        named
            .flat_map(|path| {
                tracked.iter().filter(move |file| **file == path || file.starts_with(&below(&path)))
            })
            .map(|file| (file.clone(), copy_of(file)))
            .collect()
    }

    /// The text with its links leading to pages of the site, or to copies of files, and with fences that rustdoc does not take for Rust.
    pub(super) fn rewritten(&self, text: &str) -> String {
        let (mut out, mut done) = (String::with_capacity(text.len()), 0);
        for target in link_targets(text) {
            out += &text[done..target.start];
            out += &self.link(&text[target.clone()]);
            done = target.end;
        }
        out += &text[done..];
        name_fences(&out)
    }

    fn link(&self, link: &str) -> String {
        match self.target(link) {
            Target::Site(target) => target,
            Target::File(path) if Path::new(&path).extension().is_some() => self.up() + &copy_of(&path),
            Target::File(folder) => format!("{}{FILES}/{folder}", self.up()),
        }
    }

    fn target(&self, link: &str) -> Target {
        let (file, heading) = link.split_at(link.find('#').unwrap_or(link.len()));
        if file.is_empty() || file.contains(':') {
            return Target::Site(link.to_owned());
        }
        let path = resolve(&self.source, file);
        let up = self.up();
        if let Some(page) = Self::of(&path) {
            return Target::Site(format!("{up}{}{heading}", page.target));
        }
        if let Some(picture) = path.strip_prefix("docs/img/") {
            return Target::Site(format!("{up}img/{picture}"));
        }
        match path.strip_prefix("crates/") {
            Some(krate) if !krate.contains('/') => {
                Target::Site(format!("{up}../{}/index.html", library(krate)))
            }
            _ => Target::File(path),
        }
    }
}

/// Where a link leads.
enum Target {
    /// A page, a picture or a crate of the site, relative to the page; or an address.
    Site(String),
    /// A file or a folder of the repository.
    File(String),
}

/// The copy of a file in the book: as text, since a browser saves a file of unknown type.
fn copy_of(path: &str) -> String {
    format!("{FILES}/{path}.txt")
}

/// The library in a folder of `crates`.
fn library(folder: &str) -> String {
    if folder == "wayfix" { folder.to_owned() } else { format!("wayfix_{}", folder.replace('-', "_")) }
}

fn name_fences(text: &str) -> String {
    let mut fenced = false;
    let mut lines = text.lines().map(|line| {
        let fence = line.trim_start().starts_with("```");
        fenced ^= fence;
        if fence && fenced && line.trim() == "```" {
            line.to_owned() + "text\n"
        } else {
            line.to_owned() + "\n"
        }
    });
    lines.by_ref().collect()
}

#[cfg(test)]
mod tests {
    use super::Page;

    #[test]
    fn links_lead_to_pages_crates_pictures_and_copies_of_files() {
        let page = Page::of("docs/adr/0001-records.md").unwrap();
        let text = "[a](../slam.md#walls) ![b](../img/a.svg) [c](../../crates/slam-ekf) [d](../../fixtures/a.toml) [e](https://x.y) [f](#g) [h](../../xtask)";
        assert_eq!(
            page.rewritten(text).trim_end(),
            "[a](../slam.html#walls) ![b](../img/a.svg) [c](../../wayfix_slam_ekf/index.html) \
             [d](../files/fixtures/a.toml.txt) [e](https://x.y) [f](#g) [h](../files/xtask)"
        );
        let tracked = ["fixtures/a.toml", "fixtures/b.toml", "xtask/Cargo.toml"].map(String::from);
        assert_eq!(
            page.files(text, &tracked),
            ["fixtures/a.toml", "xtask/Cargo.toml"].map(|file| (file.to_owned(), super::copy_of(file)))
        );
    }

    #[test]
    fn code_is_left_alone_and_a_fence_without_a_language_is_text() {
        let page = Page::of("docs/README.md").unwrap();
        assert_eq!(page.target, "index.html");
        assert_eq!(
            page.rewritten("```\n[a](b.md)\n```\n```sh\nls\n```\n"),
            "```text\n[a](b.md)\n```\n```sh\nls\n```\n"
        );
    }

    #[test]
    fn the_readme_of_the_repository_is_no_page() {
        assert!(Page::of("README.md").is_none());
        assert!(Page::of("docs/img/slam.svg").is_none());
    }
}
