use std::path::PathBuf;

use super::live::LiveArguments;

/// What every `wayfix run` takes.
#[derive(clap::Args)]
pub(super) struct Common {
    /// A TOML file of parameters; what it does not name keeps its default. `--print-params` shows all of them.
    #[arg(long, value_name = "FILE")]
    pub(super) params: Option<PathBuf>,
    /// Print the parameters that would be used, as TOML, and end: a file to start from.
    #[arg(long)]
    pub(super) print_params: bool,
    /// Folder for index.html, report.json, the figures as SVG and, as MCAP, the estimates.
    ///
    /// It is created where need be. Nothing is written without it.
    #[arg(long, value_name = "DIR")]
    pub(super) out: Option<PathBuf>,
    /// Print one JSON object instead of a table.
    ///
    /// `{"metrics": {name: number}, "events": {name: count}, "seed": n}`; units are in the names.
    #[arg(long)]
    pub(super) json: bool,
    /// Seed of every generator; systems that draw nothing pass it on to the output.
    #[arg(long, value_name = "N", default_value_t = 1)]
    pub(super) seed: u64,
    #[command(flatten)]
    pub(super) live: LiveArguments,
}
