//! Scans with their poses as one JSON object: `{"map": {"976052890.244111": {"range": […], "theta": …, "x": …, "y": …}, …}}`, with keys in seconds.
//!
//! The file does not state whether the poses are odometry or corrected: each gives a pose and the motion since the previous scan. The raw log of the
//! Intel Research Lab is distributed in this form.

use std::io::Read;
use std::path::Path;

use serde::de::{DeserializeSeed, Error as _, IgnoredAny, MapAccess, Visitor};
use serde_json::{Deserializer, Value};
use wayfix_estimation_traits::Pose2;

use super::half_circle::{half_circle, warn_of_assumed_field_of_view};
use super::row::{RowError, stamp};
use super::scan_odometry::ScanOdometry;
use super::time_order::{Timed, in_time_order};
use crate::formats::compressed::{end_of_damaged, open_text};
use crate::formats::format::shortened;
use crate::{
    LaserScan, LogCompleteness, LogError, LogFormat, PoseKind, ReadReport, Record, RecordData,
    RowProblemKind, Stamp,
};

/// Maximum size of a file, in bytes; it bounds the memory used.
const MAX_BYTES: u64 = 256 << 20;

/// All records, sorted by time.
pub(crate) fn read(path: &Path, poses: PoseKind, report: &mut ReadReport) -> Result<Vec<Record>, LogError> {
    let mut text = read_text(path, report)?;
    replace_non_finite(&mut text);
    let file = path.file_name().unwrap_or_default().to_string_lossy().into_owned();
    let mut scans = Vec::new();
    for (index, (key, value)) in entries(&text, report).into_iter().enumerate() {
        let row = index as u64 + 1;
        let read = parse(&key, &value).map(|(stamp, pose, scan)| {
            warn_of_assumed_field_of_view(scan.ranges.len(), report);
            scans.push(Timed { row, stamp, item: (pose, scan) });
        });
        report.count_row(&file, row, read);
    }
    // An object has no order.
    scans.sort_by_key(|scan| scan.stamp);
    let mut odometry = ScanOdometry::default();
    let to_records = |Timed { stamp, item: (pose, scan), .. }: Timed<(Pose2<f64>, LaserScan)>| {
        let motion = odometry.scan(stamp.seconds(), pose).map(RecordData::OdometryIncrement);
        let data = [Some(poses.data(pose)), motion, Some(RecordData::Scan(scan))];
        data.into_iter().flatten().map(move |data| Record { stamp, data })
    };
    let scans = in_time_order(&file, scans, report);
    Ok(scans.into_iter().flat_map(to_records).collect())
}

/// The readable part of the text of a file that may be compressed.
fn read_text(path: &Path, report: &mut ReadReport) -> Result<Vec<u8>, LogError> {
    let mut text = Vec::new();
    if let Err(error) = open_text(path)?.take(MAX_BYTES + 1).read_to_end(&mut text) {
        let end = end_of_damaged(path, &error, text.len() as u64);
        report.end = end.ok_or_else(|| LogError::io(path, error))?;
    }
    if text.len() as u64 > MAX_BYTES {
        let reason = format!("more than {MAX_BYTES} bytes");
        return Err(LogError::NotThisFormat { path: path.into(), format: LogFormat::ScanJson, reason });
    }
    Ok(text)
}

/// Replacement in the text for a number that is not finite.
const NOT_FINITE: &str = "";

/// Python writes `NaN`, `Infinity` and `-Infinity`, which JSON has no words for: an empty string of the same length with its blanks takes their place.
fn replace_non_finite(text: &mut [u8]) {
    let mut in_string = false;
    let mut at = 0;
    while let Some(byte) = text.get(at) {
        let length = match byte {
            b'\\' if in_string => 2,
            b'"' => {
                in_string = !in_string;
                1
            }
            b'N' | b'I' | b'-' if !in_string => {
                let words: [&[u8]; 3] = [b"NaN", b"Infinity", b"-Infinity"];
                match words.into_iter().find(|word| text[at..].starts_with(word)) {
                    Some(word) => {
                        text[at..at + word.len()].fill(b' ');
                        text[at..at + 2].fill(b'"');
                        word.len()
                    }
                    None => 1,
                }
            }
            _ => 1,
        };
        at += length;
    }
}

/// Every entry that is whole, in the order of the file.
fn entries(text: &[u8], report: &mut ReadReport) -> Vec<(String, Value)> {
    let mut entries = Vec::new();
    let mut json = Deserializer::from_slice(text);
    let read = Document(&mut entries).deserialize(&mut json).and_then(|()| json.end());
    match read {
        // A truncated file is already reported.
        Err(error) if report.end == LogCompleteness::Complete => {
            let line_start = text.split_inclusive(|byte| *byte == b'\n').take(error.line().saturating_sub(1));
            let byte = line_start.map(<[u8]>::len).sum::<usize>() + error.column();
            report.end = if error.is_eof() {
                LogCompleteness::Truncated { file_bytes: text.len() as u64, missing_bytes: 1 }
            } else {
                LogCompleteness::Damaged { byte: byte as u64, reason: error.to_string() }
            };
        }
        _ => {}
    }
    entries
}

fn parse(key: &str, value: &Value) -> Result<(Stamp, Pose2<f64>, LaserScan), RowError> {
    let stamp = stamp(key)?;
    let number = |name| pose_number(&value[name]).map_err(|error| error.of(key, name));
    let pose = Pose2::new(number("x")?, number("y")?, number("theta")?);
    let ranges =
        value["range"].as_array().ok_or_else(|| not_a_number("no list of numbers").of(key, "range"))?;
    let ranges: Result<Vec<f64>, RowError> = ranges.iter().map(beam).collect();
    Ok((stamp, pose, half_circle(ranges.map_err(|error| error.of(key, "range"))?)?))
}

fn pose_number(value: &Value) -> Result<f64, RowError> {
    match value.as_f64() {
        Some(number) => Ok(number),
        None if value.as_str() == Some(NOT_FINITE) => {
            Err(RowError::new(RowProblemKind::NotFinite, "not finite"))
        }
        None => Err(not_a_number("not a number")),
    }
}

/// NaN, infinity and null mean no echo.
fn beam(value: &Value) -> Result<f64, RowError> {
    match value {
        Value::Null => Ok(f64::NAN),
        Value::String(text) if text == NOT_FINITE => Ok(f64::NAN),
        value => value.as_f64().ok_or_else(|| not_a_number("not a list of numbers")),
    }
}

fn not_a_number(reason: &str) -> RowError {
    RowError::new(RowProblemKind::NotANumber, reason)
}

impl RowError {
    fn of(self, key: &str, name: &str) -> Self {
        Self { reason: format!("scan {}: {name} is {}", shortened(key), self.reason), ..self }
    }
}

/// Collects the entries of `map` one by one, so that those before a damage are kept.
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
