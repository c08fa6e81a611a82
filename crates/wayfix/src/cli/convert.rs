use std::{path::PathBuf, process::ExitCode};

use anyhow::{Result, bail};
use wayfix_sensor_log::{Format, OpenOptions};

/// Write a log in another format. MCAP keeps everything; what the others have no place for is counted.
#[derive(clap::Args)]
pub(super) struct Arguments {
    /// The log to read.
    input: PathBuf,
    /// The file to write: .mcap, .txt (range-bearing lines) or .tum (poses).
    output: PathBuf,
    /// How the input is stored. Detected when not given.
    #[arg(long)]
    from: Option<Format>,
    /// How to store the output. By default what its ending says.
    #[arg(long)]
    to: Option<Format>,
    /// Which robot, in sets of several.
    #[arg(long)]
    robot: Option<u32>,
}

pub(super) fn main(arguments: Arguments) -> Result<ExitCode> {
    let extension = arguments.output.extension().and_then(|extension| extension.to_str());
    let format = match (arguments.to, extension) {
        (Some(format), _) => format,
        (None, Some("mcap")) => Format::Mcap,
        (None, Some("txt")) => Format::RangeBearing,
        (None, Some("tum")) => Format::Tum,
        _ => bail!(
            "{}: the ending names no format, say --to mcap, range-bearing or tum",
            arguments.output.display()
        ),
    };
    let options = OpenOptions { format: arguments.from, robot: arguments.robot, ..OpenOptions::default() };
    let (records, read) = wayfix_sensor_log::open(&arguments.input, &options)?.read_all();
    if read.n_problems() > 0 {
        eprintln!("{read}");
    }
    let written = wayfix_sensor_log::write(&arguments.output, format, records)?;
    println!("{written}");
    Ok(ExitCode::SUCCESS)
}
