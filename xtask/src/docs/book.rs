//! The Markdown pages of `docs` as pages of the site, rendered by rustdoc for the same style of code and formulas.

use std::fs;
use std::path::Path;

use anyhow::{Context, Result};

use super::page::Page;
use crate::{shell, tidy};

/// Redirects the site's front page to the book.
const FRONT: &str = "<!DOCTYPE html>\n<html lang=\"en\"><meta charset=\"utf-8\"><title>Wayfix</title>\n\
    <meta http-equiv=\"refresh\" content=\"0; url=book/index.html\">\n\
    <p><a href=\"book/index.html\">Wayfix: where to begin</a>, <a href=\"wayfix/index.html\">API reference</a></p></html>\n";

/// Renders every page into `doc/book`, and prints their number.
pub(super) fn bind(doc: &Path, header: Option<&Path>) -> Result<usize> {
    let book = doc.join("book");
    if book.exists() {
        fs::remove_dir_all(&book)?;
    }
    fs::create_dir_all(&book)?;
    let root = shell::root();
    fs::copy(root.join("docs/book.css"), book.join("book.css"))?;
    fs::write(doc.join("index.html"), FRONT)?;

    let tracked = tidy::tracked()?;
    for picture in tracked.iter().filter(|path| path.starts_with("docs/img/")) {
        copy(&root.join(picture), &book.join(picture.trim_start_matches("docs/")))?;
    }
    let pages: Vec<Page> = tracked.iter().filter_map(|path| Page::of(path)).collect();
    for page in &pages {
        let text = fs::read_to_string(root.join(&page.source))?;
        for (file, copied) in page.files(&text, &tracked) {
            copy(&root.join(file), &book.join(copied))?;
        }
        render(page, &text, &book, header).with_context(|| format!("page {}", page.source))?;
    }
    Ok(pages.len())
}

fn render(page: &Page, text: &str, book: &Path, header: Option<&Path>) -> Result<()> {
    let scratch = shell::target_dir().join("book");
    let markdown = scratch.join(&page.target).with_extension("md");
    let folder = markdown.parent().context("a page lies in a folder")?;
    fs::create_dir_all(folder)?;
    fs::write(&markdown, page.rewritten(text))?;
    let banner = folder.join("banner.html");
    fs::write(&banner, page.banner())?;

    let output = book.join(&page.target);
    let output = output.parent().context("a page lies in a folder")?;
    let mut rustdoc =
        shell::command("rustdoc", &["--edition", "2024", "--markdown-no-toc", "--markdown-css"]);
    rustdoc.arg(page.up() + "book.css").arg("--html-before-content").arg(&banner);
    if let Some(header) = header {
        rustdoc.arg("--html-in-header").arg(header);
    }
    shell::check(rustdoc.arg(&markdown).arg("--output").arg(output))
}

fn copy(from: &Path, to: &Path) -> Result<()> {
    fs::create_dir_all(to.parent().context("a file lies in a folder")?)?;
    fs::copy(from, to)?;
    Ok(())
}
