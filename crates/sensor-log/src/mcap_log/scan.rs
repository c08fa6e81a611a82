//! Conversion of laser scans to and from Foxglove messages.
//!
//! `foxglove.LaserScan` has the bearings of the first and the last beam and no maximum range. The channel's metadata store the rest.

use std::collections::BTreeMap;

use foxglove::messages::{self, FrameTransform, PointCloud, Timestamp};
use wayfix_estimation_traits::Pose2;

use super::reading::decode::{decode, planar, stamp};
use super::{topics, writing::encode};
use crate::fault::{Fault, finite, inconsistent};
use crate::{LaserScan, Record, RecordData, Stamp};

const INCREMENT: &str = "angle_increment";
const RANGE_MAX: &str = "range_max";
const BEAM_PERIOD: &str = "beam_period";

/// Channel metadata common to all its scans; empty in files of other programs.
#[derive(Clone, Copy, Debug, PartialEq, Default)]
pub(super) struct ScanChannel {
    increment: Option<f64>,
    range_max: Option<f64>,
    beam_period: Option<f64>,
}

impl ScanChannel {
    pub(super) fn of<'a>(metadata: impl Iterator<Item = (&'a str, &'a str)>) -> Self {
        let mut channel = Self::default();
        for (key, value) in metadata {
            match key {
                INCREMENT => channel.increment = value.parse().ok().filter(|value: &f64| value.is_finite()),
                BEAM_PERIOD => {
                    channel.beam_period = value.parse().ok().filter(|value: &f64| value.is_finite());
                }
                RANGE_MAX => channel.range_max = value.parse().ok().filter(|value: &f64| !value.is_nan()),
                _ => {}
            }
        }
        channel
    }
}

pub(super) fn metadata(scan: &LaserScan) -> BTreeMap<String, String> {
    let pairs = [(INCREMENT, scan.angle_increment), (RANGE_MAX, scan.range_max)];
    let beam_period = (scan.beam_period != 0.0).then_some((BEAM_PERIOD, scan.beam_period));
    pairs.into_iter().chain(beam_period).map(|(key, value)| (key.to_owned(), value.to_string())).collect()
}

pub(super) fn encode_scan(timestamp: Timestamp, frame: &str, scan: &LaserScan) -> messages::LaserScan {
    messages::LaserScan {
        timestamp: Some(timestamp),
        frame_id: frame.to_owned(),
        pose: Some(encode::identity()),
        start_angle: scan.angle_min,
        end_angle: scan.bearing(scan.ranges.len().saturating_sub(1)),
        ranges: scan.ranges.clone(),
        intensities: Vec::new(),
    }
}

/// The echoes as points, for viewers that do not draw scans.
pub(super) fn encode_points(timestamp: Timestamp, frame: &str, scan: &LaserScan) -> PointCloud {
    let point = |(bearing, range): (f64, f64)| {
        let (sin, cos) = libm::sincos(bearing);
        [range * cos, range * sin]
    };
    let points: Vec<[f64; 2]> = scan.echoes().map(point).collect();
    encode::points(timestamp, frame, &points)
}

pub(super) fn encode_mount(timestamp: Timestamp, pose: &Pose2<f64>) -> FrameTransform {
    FrameTransform {
        timestamp: Some(timestamp),
        parent_frame_id: topics::BODY_FRAME.to_owned(),
        child_frame_id: topics::LASER_FRAME.to_owned(),
        translation: Some(encode::position(pose)),
        rotation: Some(encode::orientation(pose)),
    }
}

pub(super) fn mount(bytes: &[u8], log_time: Stamp) -> Result<Vec<Record>, Fault> {
    let message: FrameTransform = decode(bytes)?;
    let stamp = stamp(message.timestamp, log_time)?;
    let pose = planar(&messages::Pose { position: message.translation, orientation: message.rotation })?;
    Ok(vec![Record { stamp, data: RecordData::LaserMount(pose) }])
}

pub(super) fn scan(channel: ScanChannel, bytes: &[u8], log_time: Stamp) -> Result<Vec<Record>, Fault> {
    let message: messages::LaserScan = decode(bytes)?;
    let stamp = stamp(message.timestamp, log_time)?;
    finite([message.start_angle, message.end_angle])?;
    if message.pose.is_some_and(|pose| !is_identity(&pose)) {
        return Err(inconsistent("scan from elsewhere than the origin of its frame"));
    }
    let n_steps = message.ranges.len().saturating_sub(1).max(1);
    let scan = LaserScan {
        angle_min: message.start_angle,
        angle_increment: channel
            .increment
            .unwrap_or((message.end_angle - message.start_angle) / n_steps as f64),
        range_max: channel.range_max.unwrap_or(f64::INFINITY),
        beam_period: channel.beam_period.unwrap_or(0.0),
        ranges: message.ranges,
    };
    Ok(vec![Record { stamp, data: RecordData::Scan(scan) }])
}

/// Most writers use a missing or zero quaternion for no rotation.
fn is_identity(pose: &messages::Pose) -> bool {
    let (t, q) = (pose.position.unwrap_or_default(), pose.orientation.unwrap_or_default());
    [t.x, t.y, t.z, q.x, q.y, q.z].iter().all(|number| *number == 0.0)
}
