//! Installs the formula renderer beside the pages, which then work offline.

use std::path::Path;

use anyhow::{Context, Result, bail};

use crate::shell;

/// The npm package that draws the formulas.
const KATEX: &str = "katex@0.19.1";

/// Copies the style, script and fonts to the paths in `docs/katex-header.html`.
pub(super) fn install(doc: &Path) -> Result<()> {
    let katex = doc.join("katex");
    let stamp = katex.join("package.txt");
    if std::fs::read_to_string(&stamp).is_ok_and(|package| package == KATEX) {
        return Ok(());
    }
    if !shell::have("npm") {
        bail!("npm is missing (it brings {KATEX})");
    }
    let unpacked = shell::target_dir().join("katex");
    std::fs::create_dir_all(&unpacked)?;
    let mut pack = shell::command("npm", &["pack", "--silent", KATEX]);
    let archive = shell::output(pack.arg("--pack-destination").arg(&unpacked))?;
    let archive = archive.lines().last().context("npm pack named no file")?;
    shell::check(shell::command("tar", &["-xzf"]).arg(unpacked.join(archive)).arg("-C").arg(&unpacked))?;

    std::fs::create_dir_all(katex.join("fonts"))?;
    let dist = unpacked.join("package/dist");
    for file in ["katex.min.css", "katex.min.js"] {
        std::fs::copy(dist.join(file), katex.join(file))
            .with_context(|| format!("{KATEX} has no dist/{file}"))?;
    }
    for font in std::fs::read_dir(dist.join("fonts"))? {
        let font = font?.path();
        if font.extension().is_some_and(|extension| extension == "woff2") {
            std::fs::copy(&font, katex.join("fonts").join(font.file_name().unwrap_or_default()))?;
        }
    }
    std::fs::write(stamp, KATEX)?;
    Ok(())
}
