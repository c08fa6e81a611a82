use std::{fs, path::Path};

use anyhow::{Context, Result};

// No documentation: it would become that of every command that takes these arguments.
#[derive(clap::Args)]
pub(super) struct Topics {
    /// A topic of a ROS 2 bag to read, where several hold the same kind of record; may be given once for each kind [default: of each kind
    /// the topic with the most messages, see `wayfix info`].
    #[arg(long = "topic", value_name = "NAME")]
    pub(super) topics: Vec<String>,
}

/// Parameters from a TOML file; the error names the file and the key, or the line where the text is no TOML.
pub(super) fn read_toml<P>(path: &Path, parse: impl Fn(&str) -> Result<P, toml::de::Error>) -> Result<P> {
    let text = fs::read_to_string(path)
        .with_context(|| format!("cannot read parameters from {}", path.display()))?;
    parse(&text).with_context(|| format!("parameters in {} are not usable", path.display()))
}
