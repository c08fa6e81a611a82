use std::{fs, path::Path};

use anyhow::{Context, Result};

/// Parameters from a TOML file; the error names the file and the key, or the line where the text is no TOML.
pub(super) fn read_toml<P>(path: &Path, parse: impl Fn(&str) -> Result<P, toml::de::Error>) -> Result<P> {
    let text = fs::read_to_string(path)
        .with_context(|| format!("cannot read parameters from {}", path.display()))?;
    parse(&text).with_context(|| format!("parameters in {} are not usable", path.display()))
}
