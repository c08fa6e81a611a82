use std::collections::BTreeSet;

use nalgebra::{Isometry2, Vector3};
use wayfix_estimation_traits::{LieGroup, Pose2};
use wayfix_line_extract::{LineExtraction, LineExtractionError, LineExtractor, Scan, WallSegment};
use wayfix_scan_match::{ScanMatchError, ScanPointCloud};
use wayfix_sensor_log::{LaserScan, Stamp};
use wayfix_slam_ekf::{Observation, WallMeasurement};
use wayfix_system_core::max_echo_range;

use super::front_end::{WallSlamFrontEnd, Walls};

/// A scan that waits for the odometry that leads up to it, and where the laser was.
pub(super) struct WaitingScan {
    pub(super) stamp: Stamp,
    pub(super) scan: LaserScan,
    pub(super) laser: Pose2<f64>,
}

/// A scan, and where the laser was in the robot's frame.
#[derive(Clone)]
pub(super) struct PlacedScan {
    pub(super) scan: LaserScan,
    /// At the first beam, the stamp of the scan.
    pub(super) laser: Pose2<f64>,
    /// How the laser moves from one beam to the next, in its own frame; `None` where all beams are taken as sent at once.
    pub(super) beam_step: Option<Pose2<f64>>,
}

/// A scan that walls were taken from.
pub(super) struct KeyframeScan {
    pub(super) scan: PlacedScan,
    pub(super) cloud: ScanPointCloud,
}

/// A laser that needs longer for a scan is not one of a robot; a `time_increment` that says so is wrong, s.
const LONGEST_SWEEP: f64 = 1.0;

/// How a laser moves from one beam to the next on a robot that moves by `twist` a second; `None` where the beams' times are not known.
///
/// # Errors
/// How long the scan would have taken, s, when that is longer than a laser takes.
pub(super) fn beam_step(
    scan: &LaserScan,
    laser: &Pose2<f64>,
    twist: &Vector3<f64>,
) -> Result<Option<Pose2<f64>>, f64> {
    let sweep = scan.beam_period * scan.ranges.len() as f64;
    if sweep > LONGEST_SWEEP {
        return Err(sweep);
    }
    let robot = Pose2::exp(&(twist * scan.beam_period));
    Ok((scan.beam_period > 0.0).then(|| laser.inverse().compose(&robot).compose(laser)))
}

impl PlacedScan {
    /// The points of the scan in the frame of the robot at the first beam.
    pub(super) fn cloud(&self) -> Result<ScanPointCloud, ScanMatchError> {
        let LaserScan { angle_min, angle_increment, ranges, .. } = &self.scan;
        let (step, max_range) = (self.beam_step.as_ref(), max_echo_range(&self.scan));
        let cloud =
            ScanPointCloud::from_ranges_deskewed(*angle_min, *angle_increment, ranges, max_range, step)?;
        Ok(cloud.transformed(&self.laser))
    }

    /// The walls of the scan in the frame of the laser at the first beam.
    pub(super) fn walls(&self, extractor: &mut LineExtractor) -> Result<LineExtraction, LineExtractionError> {
        let LaserScan { angle_min, angle_increment, ranges, .. } = &self.scan;
        let (angle_min, angle_increment) = (*angle_min, *angle_increment);
        let scan = Scan { angle_min, angle_increment, ranges, max_range: max_echo_range(&self.scan) };
        let step = self.beam_step.map(|step| Isometry2::new(step.translation, step.heading()));
        extractor.extract_deskewed(&scan, step.as_ref())
    }
}

/// Half the width of a search band, standard deviations. [Andrade-Cetto 2005, Fig. 1a]
const BAND_SIGMAS: f64 = 2.0;

impl WallSlamFrontEnd {
    /// The segments that are long enough to be walls, or lie in the search band of an expected wall, as the laser would see them from where the
    /// model has it.
    pub(super) fn walls_among(
        &mut self,
        segments: &[WallSegment],
        (laser, cloud): (&Pose2<f64>, &ScanPointCloud),
        estimator: &mut Walls,
    ) -> Vec<Observation<WallMeasurement>> {
        let moved = self.mount().inverse().compose(laser);
        let expected = self.params.expected_walls.then(|| estimator.filter.expected_landmarks());
        let mut found = BTreeSet::new();
        let mut observations = Vec::with_capacity(segments.len());
        for segment in segments {
            let seen = WallMeasurement::from(segment);
            let measurement = if *laser == self.mount() { seen } else { seen.transformed(&moved) };
            let wall = expected.as_ref().and_then(|expected| expected.find(&measurement, BAND_SIGMAS));
            found.extend(wall);
            if wall.is_some() || segment.length() >= self.params.min_wall_length {
                observations.push(Observation { label: None, measurement });
            }
        }
        if let Some(expected) = expected {
            estimator.events.add("wall_expected", expected.len() as u64);
            estimator.events.add("wall_in_search_band", found.len() as u64);
            let walls = observations.iter().map(|observation| &observation.measurement);
            self.search_bands.offer(found.len(), (cloud.points(), &self.params.mount()), walls, &expected);
        }
        observations
    }
}
