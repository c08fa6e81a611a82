//! Path of a Markdown file of the repository in the site, and the targets of its links.

use crate::tidy::{link_targets, resolve};

const REPOSITORY: &str = env!("CARGO_PKG_REPOSITORY");

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

    /// The text with its links leading to pages of the site, or to the repository, and with fences that rustdoc does not take for Rust.
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

    fn link(&self, target: &str) -> String {
        let (file, heading) = target.split_at(target.find('#').unwrap_or(target.len()));
        if file.is_empty() || file.contains(':') {
            return target.to_owned();
        }
        let path = resolve(&self.source, file);
        let up = self.up();
        if let Some(page) = Self::of(&path) {
            return format!("{up}{}{heading}", page.target);
        }
        if let Some(picture) = path.strip_prefix("docs/img/") {
            return format!("{up}img/{picture}");
        }
        match path.strip_prefix("crates/") {
            Some(krate) if !krate.contains('/') => format!("{up}../{}/index.html", library(krate)),
            _ => format!("{REPOSITORY}/blob/main/{path}{heading}"),
        }
    }
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
    fn links_lead_to_pages_crates_pictures_and_the_repository() {
        let page = Page::of("docs/adr/0001-records.md").unwrap();
        let text = "[a](../slam.md#walls) ![b](../img/a.svg) [c](../../crates/slam-ekf) [d](../../fixtures/a.toml) [e](https://x.y) [f](#g)";
        assert_eq!(
            page.rewritten(text).trim_end(),
            format!(
                "[a](../slam.html#walls) ![b](../img/a.svg) [c](../../wayfix_slam_ekf/index.html) \
                 [d]({}/blob/main/fixtures/a.toml) [e](https://x.y) [f](#g)",
                super::REPOSITORY
            )
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
