use std::{
    collections::{BTreeSet, HashSet},
    mem::discriminant,
};

use wayfix_estimation_traits::{LieGroup, Pose2};
use wayfix_sensor_log::{
    Detection, DetectionTarget, EncodedImage, LaserScan, Log, LogError, ReadReport, Record, RecordData,
};

/// Records that an overview keeps whole, from the beginning of the log.
pub const OVERVIEW_HEAD: usize = 1 << 15;

/// Records that an overview keeps from the first of each kind on; the first truth after it stays too.
const AFTER_FIRST: usize = 1 << 10;

/// What must be known of a log before it is processed: its beginning, its true map, the first detection of each landmark, and the first and last records of
/// each kind, with the truth around them.
/// Scans have no ranges, and images no pixels.
#[derive(Clone, Debug, Default)]
pub struct LogOverview {
    /// In the order of the log.
    pub records: Vec<Record>,
    /// Records of the log.
    pub n_records: usize,
    /// Images of the log.
    pub n_images: usize,
    /// The result of reading.
    pub read: ReadReport,
}

impl LogOverview {
    /// Reads a log that `open` opens; the first `n_images` images keep their pixels.
    ///
    /// A log whose truth begins late is kept without thinning, since odometry must lead back from there.
    ///
    /// # Errors
    /// Returns the errors of `open`.
    pub fn read(open: impl Fn() -> Result<Log, LogError>, n_images: usize) -> Result<Self, LogError> {
        let is_true = |record: &Record| matches!(record.data, RecordData::TruePose(_));
        let thinned = Self::read_with_head(open()?, n_images, OVERVIEW_HEAD);
        if thinned.records.iter().position(is_true).is_some_and(|first| first >= OVERVIEW_HEAD) {
            return Ok(Self::read_with_head(open()?, n_images, usize::MAX));
        }
        Ok(thinned)
    }

    /// The overview of a log whose first `head` records are kept whole.
    pub fn read_with_head(mut log: Log, n_images: usize, head: usize) -> Self {
        let mut overview = Self::default();
        let mut seen: BTreeSet<u32> = BTreeSet::new();
        let (mut has_moved, mut kinds) = (None, HashSet::new());
        // Up to here all records are kept.
        let (mut head, mut wants_truth) = (head, false);
        // The last record of each kind that is not kept.
        let mut last: Vec<(usize, Record)> = Vec::new();
        for Record { stamp, data } in log.by_ref() {
            let kind = discriminant(&data);
            if kinds.insert(kind) && overview.n_records >= head {
                overview.insert(&mut last);
                (head, wants_truth) = (overview.n_records + AFTER_FIRST, true);
            }
            let is_new = has_new_landmark(&data, &mut seen)
                || matches!(data, RecordData::TrueLandmark(_) | RecordData::TrueWall(_))
                || has_truth(&data) && std::mem::take(&mut wants_truth);
            overview.n_images += usize::from(matches!(data, RecordData::Image(_)));
            let data = if overview.n_images > n_images { without_pixels(data) } else { data };
            let record = Record { stamp, data: without_ranges(data) };
            has_moved = has_moved.max(moves(&record.data));
            // The scatter of the truth of a robot that has not moved yet is its noise.
            if is_new || has_moved == Some(false) || overview.n_records < head {
                overview.records.push(record);
            } else {
                last.retain(|(_, other)| discriminant(&other.data) != kind);
                last.push((overview.records.len(), record));
            }
            overview.n_records += 1;
        }
        overview.insert(&mut last);
        overview.read = log.report().clone();
        overview
    }

    /// Inserts records at their places.
    fn insert(&mut self, last: &mut Vec<(usize, Record)>) {
        for (place, record) in last.drain(..).rev() {
            self.records.insert(place, record);
        }
    }
}

/// Whether odometry shows motion; `None` for other records.
fn moves(data: &RecordData) -> Option<bool> {
    match data {
        RecordData::Velocity(velocity) => Some(velocity.linear != 0.0 || velocity.angular != 0.0),
        RecordData::Ackermann(drive) => Some(drive.wheel_speed != 0.0),
        RecordData::OdometryIncrement(increment) => Some(*increment != Pose2::identity()),
        _ => None,
    }
}

fn has_truth(data: &RecordData) -> bool {
    use RecordData::{EstimatedPose, TruePose, TruePosition};
    matches!(data, EstimatedPose(_) | TruePose(_) | TruePosition(_))
}

fn has_new_landmark(data: &RecordData, seen: &mut BTreeSet<u32>) -> bool {
    let is_new =
        |detection: &Detection| matches!(detection.target, DetectionTarget::Landmark(id) if seen.insert(id));
    match data {
        RecordData::Detections(detections) => detections.iter().map(is_new).fold(false, |any, new| any | new),
        _ => false,
    }
}

fn without_pixels(data: RecordData) -> RecordData {
    let without = |image: EncodedImage| EncodedImage { bytes: [].into(), ..image };
    match data {
        RecordData::Image(image) => RecordData::Image(without(image)),
        RecordData::TrueLabels(image) => RecordData::TrueLabels(without(image)),
        data => data,
    }
}

fn without_ranges(data: RecordData) -> RecordData {
    match data {
        RecordData::Scan(scan) => RecordData::Scan(LaserScan { ranges: Vec::new(), ..scan }),
        data => data,
    }
}
