use std::collections::{BTreeMap, BTreeSet};
use std::fmt;

use crate::{
    DetectionTarget, Log, LogImageStatistics, LogMetadata, LogScanStatistics, ReadReport, RecordData, Stamp,
};

/// Content of a log; `Display` prints it for people.
/// ```
/// use wayfix_sensor_log::{LogSummary, LogOpenOptions, open};
/// # let folder = tempfile::tempdir()?;
/// # let path = folder.path().join("walk.txt");
/// std::fs::write(&path, "O 1 0 0\nZ 7 2 0.1\nZ ? 3 0.2\nO 1 0 0\nZ 7 1 0.2\n")?;
/// let summary = LogSummary::of(open(&path, &LogOpenOptions::default())?);
/// assert_eq!(summary.kinds["odometry increment"].count, 2);
/// assert_eq!(summary.landmarks_seen.iter().copied().collect::<Vec<_>>(), [7]);
/// assert!((summary.duration_seconds() - 0.1).abs() < 1e-9);
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
#[derive(Clone, Debug, PartialEq)]
#[non_exhaustive]
pub struct LogSummary {
    /// Metadata of the log.
    pub meta: LogMetadata,
    /// Stamps of the first and the last record.
    pub span: Option<(Stamp, Stamp)>,
    /// Number of records of each kind.
    pub kinds: BTreeMap<&'static str, RecordKindSummary>,
    /// Single detections, of anything.
    pub n_detections: u64,
    /// Landmarks with a known true position.
    pub landmarks_surveyed: BTreeSet<u32>,
    /// Detected landmarks.
    pub landmarks_seen: BTreeSet<u32>,
    /// Detected robots.
    pub robots_seen: BTreeSet<u32>,
    /// Codes that the log's own table does not list, with their number of detections.
    pub unknown_codes: BTreeMap<u32, u64>,
    /// Number of detections without identity.
    pub n_unlabelled: u64,
    /// Images by kind of record.
    pub images: BTreeMap<&'static str, LogImageStatistics>,
    /// Laser scans.
    pub scans: LogScanStatistics,
    /// Report of the reading.
    pub report: ReadReport,
}

/// Records of one kind.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct RecordKindSummary {
    /// Number of records.
    pub count: u64,
    /// Stamp of the first.
    pub first: Stamp,
    /// Stamp of the last.
    pub last: Stamp,
}

impl RecordKindSummary {
    /// Mean rate; `None` for records that all have the same stamp.
    pub fn rate_hz(&self) -> Option<f64> {
        let seconds = self.last.seconds_since(self.first);
        (seconds > 0.0).then(|| (self.count - 1) as f64 / seconds)
    }
}

impl LogSummary {
    /// Reads the log to its end.
    pub fn of(mut log: Log) -> Self {
        let mut summary = Self {
            meta: log.meta().clone(),
            span: None,
            kinds: BTreeMap::new(),
            n_detections: 0,
            landmarks_surveyed: BTreeSet::new(),
            landmarks_seen: BTreeSet::new(),
            robots_seen: BTreeSet::new(),
            unknown_codes: BTreeMap::new(),
            n_unlabelled: 0,
            images: BTreeMap::new(),
            scans: LogScanStatistics::default(),
            report: ReadReport::default(),
        };
        for record in log.by_ref() {
            summary.add(record.stamp, &record.data);
        }
        summary.report = log.report().clone();
        summary
    }

    /// From the first record to the last, seconds.
    pub fn duration_seconds(&self) -> f64 {
        self.span.map_or(0.0, |(first, last)| last.seconds_since(first))
    }

    fn add(&mut self, stamp: Stamp, data: &RecordData) {
        self.span = Some((self.span.map_or(stamp, |(first, _)| first), stamp));
        let kind = self.kinds.entry(data.kind()).or_insert(RecordKindSummary {
            count: 0,
            first: stamp,
            last: stamp,
        });
        kind.count += 1;
        kind.last = stamp;
        match data {
            RecordData::TrueLandmark(landmark) => drop(self.landmarks_surveyed.insert(landmark.id)),
            RecordData::Detections(detections) => {
                detections.iter().for_each(|detection| self.add_detection(detection.target));
            }
            RecordData::Scan(scan) => self.scans.add(scan),
            RecordData::Image(image) | RecordData::TrueLabels(image) => {
                self.images.entry(data.kind()).or_default().add(image);
            }
            _ => {}
        }
    }

    fn add_detection(&mut self, target: DetectionTarget) {
        self.n_detections += 1;
        match target {
            DetectionTarget::Landmark(id) => drop(self.landmarks_seen.insert(id)),
            DetectionTarget::Robot(id) => drop(self.robots_seen.insert(id)),
            DetectionTarget::UnknownCode(code) => *self.unknown_codes.entry(code).or_default() += 1,
            DetectionTarget::Unlabelled => self.n_unlabelled += 1,
        }
    }
}

impl fmt::Display for LogSummary {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(f, "{}: {}", self.meta.source.display(), self.meta.format)?;
        if let Some(origin) = self.meta.origin {
            write!(f, " converted from {origin}")?;
        }
        if let Some(robot) = self.meta.robot {
            write!(f, ", robot {robot}")?;
        }
        writeln!(f, ", {:.1} s", self.duration_seconds())?;
        for topic in &self.meta.topics {
            writeln!(f, "  {topic}")?;
        }
        for (kind, summary) in &self.kinds {
            write!(f, "  {kind:20} {:7} records", summary.count)?;
            match summary.rate_hz() {
                Some(rate) => writeln!(f, " {rate:8.1} Hz")?,
                None => writeln!(f)?,
            }
        }
        if self.n_detections > 0 {
            writeln!(f, "  seen {} times: {}", self.n_detections, self.what_was_seen().join("; "))?;
        }
        for (kind, images) in &self.images {
            writeln!(f, "  {kind}: {images}")?;
        }
        if !self.scans.sizes.is_empty() {
            writeln!(f, "  laser scans: {}", self.scans)?;
        }
        write!(f, "{}", self.report)
    }
}

impl LogSummary {
    fn what_was_seen(&self) -> Vec<String> {
        let mut seen = Vec::new();
        if !self.landmarks_seen.is_empty() {
            let n_surveyed = self.landmarks_seen.intersection(&self.landmarks_surveyed).count();
            let n_seen = self.landmarks_seen.len();
            seen.push(format!("{n_seen} landmarks with identity, {n_surveyed} of them with true position"));
        }
        if self.n_unlabelled > 0 {
            seen.push(format!("{} times something without identity", self.n_unlabelled));
        }
        if !self.robots_seen.is_empty() {
            let robots: Vec<String> = self.robots_seen.iter().map(|robot| format!("robot {robot}")).collect();
            seen.push(robots.join(", "));
        }
        if !self.unknown_codes.is_empty() {
            let n_detections: u64 = self.unknown_codes.values().sum();
            seen.push(format!("{} unknown codes ({n_detections} times)", self.unknown_codes.len()));
        }
        seen
    }
}
