use std::{
    collections::BTreeSet,
    path::{Path, PathBuf},
    process::ExitCode,
};

use anyhow::Result;
use wayfix_evaluation::terminal::print;
use wayfix_sensor_log::{LogOpenOptions, LogSummary, RecordData};
use wayfix_table_log::RangeRecording;

use super::{
    input::Topics,
    run::run_ranges::{SlamLogFormat, slam_log_format},
};

/// Show the content of a log: kinds of records with their rates, landmarks, robots, and read problems.
#[derive(clap::Args)]
#[command(after_long_help = FORMATS)]
pub(super) struct Arguments {
    /// The log: a file, or the folder of a UTIAS set, of Victoria Park, of Plaza or of images.
    path: PathBuf,
    /// Input format [default: detected from the content].
    #[arg(long, value_parser = slam_log_format())]
    format: Option<SlamLogFormat>,
    /// Number of the robot, for sets with several robots.
    #[arg(long, value_name = "N")]
    robot: Option<u32>,
    #[command(flatten)]
    topics: Topics,
}

const FORMATS: &str = "\
Formats:
  utias          a folder with Barcodes.dat and RobotN_{Odometry,Measurement,Groundtruth}.dat
  victoria-park  a folder with odometry.csv (t_s,speed_mps,steering_rad), trees.csv (t_s,range_m,bearing_rad,diameter_m;
                 bearing 0 to the right) and, for figures, gps.csv (t_s,x_m,y_m)
  plaza          a folder with odometry.csv (t_s,distance_m,turn_rad), ranges.csv (t_s,beacon,range_m) and, for figures,
                 truth.csv (t_s,x_m,y_m,heading_rad) and beacons.csv (beacon,x_m,y_m)
  range-bearing  text without stamps, a step every 0.1 s, each in the order P, O, Z
                   L id x y              a true landmark, m
                   P x y heading         the true pose, m and rad
                   O dx dy dheading      motion since the last step, in the robot frame before it
                   Z id range bearing    a detection, m and rad, 0 ahead, counter-clockwise; id ? when unknown
                 L and P are for figures only and may be absent.
  tum            t x y z qx qy qz qw lines: poses only
  carmen         FLASER, ROBOTLASER1 or RAWLASER1 scans, ODOM and PARAM lines; the order is that of the lines
  scan-json      an object \"map\" of objects by their seconds, each with the list \"range\", \"theta\", \"x\" and \"y\"
  mcap           Foxglove protobuf messages on /odom/velocity (Odometry) or /odom/increment (PoseInFrame),
                 or /odom/ackermann (JointStates wheel, steering), /sightings (PointCloud with range, bearing, kind, id),
                 /scan (LaserScan), /truth/pose (PoseInFrame), /truth/position (PointCloud with x, y),
                 /truth/landmarks (PointCloud with x, y, id), /camera/info (CameraCalibration), /camera/mount
                 (FrameTransform), /camera/image and /truth/labels (CompressedImage);
                 or ROS 2 messages as `ros2 bag record -s mcap` writes them, on any topic: LaserScan, Odometry, Image,
                 CompressedImage, CameraInfo, PoseStamped, PoseWithCovarianceStamped, TwistStamped, Twist, TFMessage.
                 Of each kind the topic with the most messages is read; --topic chooses another. Poses are true on
                 topics with truth, gt, mocap, vicon, optitrack or qualisys in the name.
  images         a folder of PNG and JPEG files, frames by name, 30 Hz
Text may be compressed with gzip.";

pub(super) fn main(arguments: Arguments) -> Result<ExitCode> {
    let format = match arguments.format {
        Some(SlamLogFormat::Plaza) => return ranges(&arguments.path),
        None if RangeRecording::is_in(&arguments.path) => return ranges(&arguments.path),
        Some(SlamLogFormat::Log(format)) => Some(format),
        None => None,
    };
    let options = LogOpenOptions {
        format,
        robot: arguments.robot,
        topics: arguments.topics.topics,
        ..LogOpenOptions::default()
    };
    let summary = LogSummary::of(wayfix_sensor_log::open(&arguments.path, &options)?);
    print(format!("{summary}{}\n", usable_for(&summary).join("\n")))?;
    Ok(ExitCode::SUCCESS)
}

/// The content of a folder of ranges to beacons.
fn ranges(folder: &Path) -> Result<ExitCode> {
    let RangeRecording { odometry, ranges, truth, report } = RangeRecording::read(folder)?;
    let seconds = match (odometry.first(), odometry.last()) {
        (Some((first, _)), Some((last, _))) => last.seconds_since(*first),
        _ => 0.0,
    };
    let beacons: BTreeSet<u32> = ranges.iter().map(|row| row.beacon).collect();
    let n_poses = truth.iter().filter(|record| matches!(record.data, RecordData::TruePose(_))).count();
    print(format!(
        "{}: plaza, {seconds:.1} s
  {:<20} {:>7} records
  {:<20} {:>7} records, of {} beacons, {} of them with true position
  {:<20} {n_poses:>7} records
{report}\
usable for `wayfix run slam --estimator smoother`, {}\n",
        folder.display(),
        "odometry increment",
        odometry.len(),
        "range",
        ranges.len(),
        beacons.len(),
        truth.len() - n_poses,
        "true pose",
        figures(n_poses > 0)
    ))?;
    Ok(ExitCode::SUCCESS)
}

fn figures(has_truth: bool) -> &'static str {
    match has_truth {
        true => "with figures of accuracy",
        false => "without true poses there are no figures of accuracy",
    }
}

/// The systems of `wayfix run` that can use a log; if there are none, the missing records.
fn usable_for(summary: &LogSummary) -> Vec<String> {
    let has = |kinds: &[&str]| kinds.iter().any(|kind| summary.kinds.contains_key(kind));
    let steps = has(&["velocity", "odometry increment"]);
    let moves = steps || has(&["ackermann drive"]);
    let sees_landmarks = !summary.landmarks_seen.is_empty() || summary.n_unlabelled > 0;
    let scans = has(&["laser scan"]);
    let figures = figures(has(&["true pose", "true position"]));
    let systems = [
        (sees_landmarks && moves, "slam", figures),
        (!sees_landmarks && scans && steps, "slam", figures),
        (scans, "lines", "the walls of every scan"),
        (has(&["image"]) && has(&["camera info"]) && moves, "color", "with a map of coloured things, --map"),
        (has(&["image"]), "track", "with the target's box in the first image, --init"),
        (has(&["image"]) && steps, "cml", "if the images are panoramas"),
    ];
    let fits = systems.iter().filter(|(fits, ..)| *fits);
    let mut lines: Vec<String> =
        fits.map(|(_, system, remark)| format!("usable for `wayfix run {system}`, {remark}")).collect();
    if sees_landmarks && !moves {
        lines.push("not usable for `wayfix run slam`: no odometry (velocities or increments)".to_owned());
    } else if !sees_landmarks && scans && !steps {
        lines.push(
            "not usable for `wayfix run slam`: maps of walls need odometry increments or velocities"
                .to_owned(),
        );
    }
    if lines.is_empty() {
        lines.push(
            "usable for no `wayfix run`: neither detections of landmarks nor laser scans nor images"
                .to_owned(),
        );
    }
    lines
}
