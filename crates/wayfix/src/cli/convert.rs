use std::{path::PathBuf, process::ExitCode};

use anyhow::{Result, bail};
use wayfix_evaluation::terminal::{print, print_message};
use wayfix_sensor_log::{LogFormat, LogOpenOptions};

use super::input::{Topics, log_format};

/// Write a log in another format.
///
/// A ROS 2 bag becomes MCAP with Foxglove's schemas; one topic of each kind of record is converted (`--topic`).
///
/// MCAP stores everything, including the origin of the records; Foxglove and Rerun open it. Records that another format cannot store are skipped and
/// counted: range-bearing text has no stamps, velocities and scans; TUM has only poses, the estimated ones if there are any.
#[derive(clap::Args)]
#[command(after_help = EXAMPLES)]
pub(super) struct Arguments {
    /// The log to read: a file, or the folder of a UTIAS set, of Victoria Park or of images (30 Hz).
    input: PathBuf,
    /// The file to write: .mcap, .txt (range-bearing lines) or .tum (poses).
    output: PathBuf,
    /// Input format [default: detected from the content].
    #[arg(long, value_name = "FORMAT", value_parser = log_format())]
    from: Option<LogFormat>,
    /// Output format: mcap, range-bearing or tum [default: from the file extension].
    #[arg(long, value_name = "FORMAT", value_parser = log_format(), hide_possible_values = true)]
    to: Option<LogFormat>,
    /// Number of the robot, for sets with several robots.
    #[arg(long, value_name = "N")]
    robot: Option<u32>,
    #[command(flatten)]
    topics: Topics,
}

const EXAMPLES: &str = "\
Examples:
  wayfix convert slam_100.txt slam_100.mcap
  wayfix convert MRCLAM_Dataset7 robot3.mcap --robot 3
  wayfix convert results/estimates.mcap path.tum
  wayfix convert rosbag2_0.mcap drive.mcap --topic /scan_rear";

pub(super) fn main(arguments: Arguments) -> Result<ExitCode> {
    let extension = arguments.output.extension().and_then(|extension| extension.to_str());
    let format = match (arguments.to, extension) {
        (Some(format), _) => format,
        (None, Some("mcap")) => LogFormat::Mcap,
        (None, Some("txt")) => LogFormat::RangeBearing,
        (None, Some("tum")) => LogFormat::Tum,
        _ => bail!(
            "{}: the ending names no format, say --to mcap, range-bearing or tum",
            arguments.output.display()
        ),
    };
    let options = LogOpenOptions {
        format: arguments.from,
        robot: arguments.robot,
        topics: arguments.topics.topics,
        ..LogOpenOptions::default()
    };
    let log = wayfix_sensor_log::open(&arguments.input, &options)?;
    let (read, written) = wayfix_sensor_log::convert(log, &arguments.output, format)?;
    if !read.is_clean() {
        print_message(read);
    }
    print(written)?;
    Ok(ExitCode::SUCCESS)
}
