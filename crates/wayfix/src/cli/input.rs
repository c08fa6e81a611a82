use std::path::PathBuf;

use clap::builder::{PossibleValuesParser, TypedValueParser};
use wayfix_sensor_log::LogFormat;

/// A format of a log by its name; for a mistyped name the error gives the most similar one.
pub(super) fn log_format() -> impl TypedValueParser<Value = LogFormat> {
    PossibleValuesParser::new(LogFormat::ALL.map(LogFormat::name)).try_map(|name| name.parse::<LogFormat>())
}

// No documentation: it would become that of every command that takes these arguments.
#[derive(clap::Args)]
pub(super) struct Topics {
    /// A topic of a ROS 2 bag to read, if several hold the same kind of record; may be given once for each kind [default: of each kind
    /// the topic with the most messages, see `wayfix info`].
    #[arg(long = "topic", value_name = "NAME")]
    pub(super) topics: Vec<String>,
}

/// Name of the input for the report: the log or its files.
pub(super) fn name_of(log: &[PathBuf]) -> String {
    log.iter().map(|path| path.display().to_string()).collect::<Vec<_>>().join(", ")
}
