//! Scans with their poses as one JSON object: `{"map": {"976052890.244111": {"range": […], "theta": …, "x": …, "y": …}, …}}`, the keys seconds.
//!
//! Whether the poses are odometry or corrected, the file does not say: each comes out as a pose and as the motion since the scan before.
//! The raw log of the Intel Research Lab is spread in this form.

use std::io::Read;
use std::path::Path;

use serde::Deserialize;
use serde::de::{DeserializeSeed, Error as _, IgnoredAny, MapAccess, Visitor};
use serde_json::{Deserializer, Value};
use wayfix_estimation_traits::Pose2;

use super::half_circle::half_circle;
use super::row::{RowError, stamp};
use super::scan_odometry::ScanOdometry;
use crate::compressed::{end_of_damaged, open_text};
use crate::{Data, Format, LaserScan, LogEnd, LogError, PoseKind, ProblemKind, ReadReport, Record, Stamp};

/// No log in this form is larger; what is must not fill the memory.
const MAX_BYTES: u64 = 256 << 20;

/// All records, sorted by time.
pub(crate) fn read(path: &Path, poses: PoseKind, report: &mut ReadReport) -> Result<Vec<Record>, LogError> {
    let text = read_text(path, report)?;
    let file = path.file_name().unwrap_or_default().to_string_lossy().into_owned();
    let mut scans = Vec::new();
    for (index, (key, value)) in entries(&text, report).into_iter().enumerate() {
        let read = parse(&key, value).map(|scan| scans.push(scan));
        report.count_row(&file, index as u64 + 1, read);
    }
    scans.sort_by_key(|(stamp, ..)| *stamp);
    let mut odometry = ScanOdometry::default();
    let to_records = |(stamp, pose, scan): (Stamp, Pose2<f64>, LaserScan)| {
        let motion = odometry.scan(stamp.seconds(), pose).map(Data::OdometryIncrement);
        let data = [Some(poses.data(pose)), motion, Some(Data::Scan(scan))];
        data.into_iter().flatten().map(move |data| Record { stamp, data })
    };
    Ok(scans.into_iter().flat_map(to_records).collect())
}

/// The text of a file that may be compressed, as far as it can be read.
fn read_text(path: &Path, report: &mut ReadReport) -> Result<Vec<u8>, LogError> {
    let mut text = Vec::new();
    if let Err(error) = open_text(path)?.take(MAX_BYTES + 1).read_to_end(&mut text) {
        let end = end_of_damaged(path, &error, text.len() as u64);
        report.end = end.ok_or_else(|| LogError::io(path, error))?;
    }
    if text.len() as u64 > MAX_BYTES {
        let reason = format!("more than {MAX_BYTES} bytes");
        return Err(LogError::NotThisFormat { path: path.into(), format: Format::ScanJson, reason });
    }
    Ok(text)
}

/// Every entry that is whole, in the order of the file.
fn entries(text: &[u8], report: &mut ReadReport) -> Vec<(String, Value)> {
    let mut entries = Vec::new();
    let mut json = Deserializer::from_slice(text);
    let read = Document(&mut entries).deserialize(&mut json).and_then(|()| json.end());
    match read {
        // A file that unpacks only in part has said so.
        Err(error) if report.end == LogEnd::Complete => {
            let line_start = text.split_inclusive(|byte| *byte == b'\n').take(error.line().saturating_sub(1));
            let byte = line_start.map(<[u8]>::len).sum::<usize>() + error.column();
            report.end = if error.is_eof() {
                LogEnd::Truncated { file_bytes: text.len() as u64, missing_bytes: 1 }
            } else {
                LogEnd::Damaged { byte: byte as u64, reason: error.to_string() }
            };
        }
        _ => {}
    }
    entries
}

#[derive(Deserialize)]
struct Entry {
    range: Vec<f64>,
    theta: f64,
    x: f64,
    y: f64,
}

fn parse(key: &str, value: Value) -> Result<(Stamp, Pose2<f64>, LaserScan), RowError> {
    let stamp = stamp(key)?;
    let entry = Entry::deserialize(value)
        .map_err(|error| RowError::new(ProblemKind::NotANumber, format!("scan {key}: {error}")))?;
    Ok((stamp, Pose2::new(entry.x, entry.y, entry.theta), half_circle(entry.range)?))
}

/// Collects the entries of `map` as they come, so that those before a damage are not lost.
struct Document<'a>(&'a mut Vec<(String, Value)>);
struct Scans<'a>(&'a mut Vec<(String, Value)>);

impl<'de> DeserializeSeed<'de> for Document<'_> {
    type Value = ();
    fn deserialize<D: serde::Deserializer<'de>>(self, json: D) -> Result<(), D::Error> {
        json.deserialize_map(self)
    }
}

impl<'de> Visitor<'de> for Document<'_> {
    type Value = ();
    fn expecting(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        f.write_str("an object with \"map\"")
    }
    fn visit_map<A: MapAccess<'de>>(self, mut object: A) -> Result<(), A::Error> {
        let mut has_map = false;
        while let Some(key) = object.next_key::<String>()? {
            if key == "map" {
                has_map = true;
                object.next_value_seed(Scans(self.0))?;
            } else {
                object.next_value::<IgnoredAny>()?;
            }
        }
        if has_map { Ok(()) } else { Err(A::Error::custom("no \"map\" in the object")) }
    }
}

impl<'de> DeserializeSeed<'de> for Scans<'_> {
    type Value = ();
    fn deserialize<D: serde::Deserializer<'de>>(self, json: D) -> Result<(), D::Error> {
        json.deserialize_map(self)
    }
}

impl<'de> Visitor<'de> for Scans<'_> {
    type Value = ();
    fn expecting(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        f.write_str("scans by their time")
    }
    fn visit_map<A: MapAccess<'de>>(self, mut scans: A) -> Result<(), A::Error> {
        while let Some(entry) = scans.next_entry()? {
            self.0.push(entry);
        }
        Ok(())
    }
}
