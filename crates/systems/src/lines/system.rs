use std::{convert::Infallible, time::Duration};

use wayfix_estimation_traits::{LieGroup, Pose2};
use wayfix_evaluation::plot::Decimated;
use wayfix_line_extract::{LineExtractionError, LineExtractionParams, LineExtractor, Scan, WallSegment};
use wayfix_sensor_log::{LaserScan, Record, RecordData, Stamp, TrueWall};
use wayfix_system_core::{EventCounts, MOST_ESTIMATES, Stopwatch, System, max_echo_range};

use super::totals::LineTotals;

/// Extracts the walls of every scan of a log.
pub struct LineExtractionSystem {
    extractor: LineExtractor,
    pose: Option<(Stamp, Pose2<f64>)>,
    mount: Pose2<f64>,
    sample: Decimated<ScanWalls>,
    path: Decimated<(f64, f64)>,
    latest: Option<ScanWalls>,
    pub(super) totals: LineTotals,
    true_walls: Vec<TrueWall>,
    n_scans: u64,
    events: EventCounts,
}

/// Scans that are kept for pictures.
const MOST_SCANS: usize = 256;

/// A scan and the walls in it.
#[derive(Clone, Debug)]
pub struct ScanWalls {
    /// Capture time.
    pub stamp: Stamp,
    /// Pose of the laser, if the log has one at this stamp; truth takes precedence over estimates.
    pub pose: Option<Pose2<f64>>,
    /// Echoes: bearing, rad, and range, m.
    pub echoes: Vec<(f64, f64)>,
    /// Walls in the sensor frame.
    pub segments: Vec<WallSegment>,
    /// Computing time.
    pub step: Duration,
}

impl LineExtractionSystem {
    /// Creates a system with these extraction parameters.
    ///
    /// # Errors
    /// Returns an error if a parameter makes no sense.
    pub fn new(params: LineExtractionParams) -> Result<Self, LineExtractionError> {
        let extractor = LineExtractor::new(params)?;
        Ok(Self {
            extractor,
            pose: None,
            mount: Pose2::identity(),
            sample: Decimated::new(MOST_SCANS),
            path: Decimated::new(MOST_ESTIMATES),
            latest: None,
            totals: LineTotals::default(),
            true_walls: Vec::new(),
            n_scans: 0,
            events: EventCounts::default(),
        })
    }

    /// Some of the processed scans, evenly spaced: all of a short log, at most 256 of a long one.
    pub fn sample(&self) -> &[ScanWalls] {
        self.sample.kept()
    }

    /// Positions of the laser at the processed scans with a pose, m; of a long log evenly spaced ones. A path through the kept scans would cut corners.
    pub fn path(&self) -> &[(f64, f64)] {
        self.path.kept()
    }

    /// The last processed scan.
    pub fn latest(&self) -> Option<&ScanWalls> {
        self.latest.as_ref()
    }

    /// The true walls of the log so far.
    pub fn true_walls(&self) -> &[TrueWall] {
        &self.true_walls
    }

    /// Number of scans in the log, including unusable ones, which the events explain.
    pub fn n_scans(&self) -> u64 {
        self.n_scans
    }

    fn take_scan(&mut self, stamp: Stamp, scan: &LaserScan) -> Result<(), String> {
        self.n_scans += 1;
        let echoes: Vec<(f64, f64)> = scan.echoes().collect();
        if echoes.is_empty() {
            return Err(format!("none of {} beams came back", scan.ranges.len()));
        }
        let max_range = max_echo_range(scan);
        let LaserScan { angle_min, angle_increment, ranges, .. } = scan;
        let scan = Scan { angle_min: *angle_min, angle_increment: *angle_increment, ranges, max_range };
        let stopwatch = Stopwatch::start();
        let found = self.extractor.extract(&scan).map_err(|error| error.to_string())?;
        let step = stopwatch.elapsed();
        let pose = self.pose.filter(|(at, _)| *at == stamp).map(|(_, pose)| pose.compose(&self.mount));
        if let Some(pose) = pose {
            self.path.push((pose.x(), pose.y()));
        }
        self.events.add("beam_without_echo", found.counts.skipped() as u64);
        let scan = ScanWalls { stamp, pose, echoes, segments: found.segments, step };
        self.totals.add(&scan, &self.true_walls);
        let Ok(()) = self.sample.offer(|| Ok::<_, Infallible>(scan.clone()));
        self.latest = Some(scan);
        Ok(())
    }
}

impl System for LineExtractionSystem {
    fn take(&mut self, record: &Record) -> Result<(), String> {
        match &record.data {
            RecordData::TruePose(pose) => self.pose = Some((record.stamp, *pose)),
            RecordData::EstimatedPose(pose) if self.pose.is_none_or(|(at, _)| at != record.stamp) => {
                self.pose = Some((record.stamp, *pose));
            }
            RecordData::LaserMount(mount) => self.mount = *mount,
            RecordData::TrueWall(wall) => self.true_walls.push(*wall),
            RecordData::Scan(scan) => return self.take_scan(record.stamp, scan),
            _ => {}
        }
        Ok(())
    }

    fn events(&mut self) -> &mut EventCounts {
        &mut self.events
    }
}
