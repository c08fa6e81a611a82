use std::process::ExitCode;

use anyhow::Result;
use clap::ValueEnum;
use schemars::JsonSchema;
use serde::Serialize;
use wayfix_evaluation::terminal::print;
use wayfix_slam_system::{
    points::{PointSlamParams, RobotProfile},
    walls::WallSlamParams,
};
use wayfix_systems::{cml::CmlParams, color::ColorSystemParams, track::TrackParams, views::ViewsParams};

use crate::commented::{commented, schema_of};

/// Print the parameters of a system with their defaults, units and descriptions: a template for `--params`.
///
/// A parameter file only needs the keys that differ from the defaults; an unknown key is an error. A key that is not set by default is a
/// comment that shows its syntax. `--schema` prints the JSON schema instead, with which editors complete and check such files.
#[derive(clap::Args)]
#[command(after_long_help = EXAMPLES)]
pub(super) struct Arguments {
    /// The system.
    system: SystemName,
    /// The robot profile whose defaults are shown, for `slam`.
    #[arg(long, value_enum, value_name = "NAME", default_value = "generic")]
    profile: RobotProfile,
    /// Print the JSON schema.
    #[arg(long)]
    schema: bool,
}

const EXAMPLES: &str = "\
Examples:
  wayfix params slam --profile utias > robot.toml     then: wayfix run slam --log … --params robot.toml
  wayfix params lines --schema > lines.schema.json";

#[derive(Clone, Copy, ValueEnum)]
enum SystemName {
    /// EKF-SLAM with points: `run slam` on detections.
    Slam,
    /// EKF-SLAM with walls: `run slam` on laser scans.
    Walls,
    /// Walls in scans: `run lines`.
    Lines,
    /// Colour localization: `run color`.
    Color,
    /// Views of a scene: `run views`.
    Views,
    /// A target in pictures: `run track`.
    Track,
    /// Appearance maps: `run cml`.
    Cml,
}

pub(super) fn main(arguments: Arguments) -> Result<ExitCode> {
    let text = match arguments.system {
        SystemName::Slam => text(&PointSlamParams::of(arguments.profile), arguments.schema),
        SystemName::Walls => text(&WallSlamParams::default(), arguments.schema),
        SystemName::Lines => text(&wayfix_line_extract::LineExtractionParams::default(), arguments.schema),
        SystemName::Color => text(&ColorSystemParams::default(), arguments.schema),
        SystemName::Views => text(&ViewsParams::default(), arguments.schema),
        SystemName::Track => text(&TrackParams::default(), arguments.schema),
        SystemName::Cml => text(&CmlParams::default(), arguments.schema),
    };
    print(text?)?;
    Ok(ExitCode::SUCCESS)
}

fn text<P: JsonSchema + Serialize>(params: &P, schema: bool) -> Result<String> {
    if schema { Ok(serde_json::to_string_pretty(&schema_of::<P>())? + "\n") } else { commented(params) }
}
