use std::path::PathBuf;

use super::live::LiveArguments;

/// Options of every `wayfix run`.
#[derive(clap::Args)]
pub(super) struct Common {
    /// A TOML file of parameters; omitted keys keep their defaults. `--print-params` shows all of them.
    #[arg(long, value_name = "FILE")]
    pub(super) params: Option<PathBuf>,
    /// Print the effective parameters as TOML and exit: a template for `--params`.
    #[arg(long)]
    pub(super) print_params: bool,
    /// Folder for index.html, report.json, the figures as SVG and the estimates as MCAP.
    ///
    /// It is created if missing. Without this option no files are written.
    #[arg(long, value_name = "DIR")]
    pub(super) out: Option<PathBuf>,
    /// Write no MCAP of the estimates to --out.
    #[arg(long, requires = "out")]
    pub(super) no_mcap: bool,
    /// Write the estimates without the records of the log.
    #[arg(long)]
    pub(super) no_echo: bool,
    /// Print one JSON object instead of a table.
    ///
    /// `{"metrics": {name: number}, "events": {name: count}, "seed": n}`; units are in the names.
    #[arg(long)]
    pub(super) json: bool,
    /// Seed of every generator; systems without randomness only copy it to the output.
    #[arg(long, value_name = "N", default_value_t = 1)]
    pub(super) seed: u64,
    #[command(flatten)]
    pub(super) live: LiveArguments,
}
