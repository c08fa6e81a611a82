use nalgebra::Vector2;
use wayfix_estimation_traits::{LieGroup, Pose2};
use wayfix_evaluation::plot::Decimated;

use super::scan::PlacedScan;
use crate::system::largest_echo;

/// Keyframes of which points are kept.
const MOST_SCANS: usize = 256;
/// Points that are kept of a keyframe.
const MOST_POINTS: usize = 90;

/// Some points of some keyframes for the picture of the map, evenly spaced, at the poses that were estimated then.
pub(super) struct ScanSample(Decimated<Vec<(f64, f64)>>);

impl Default for ScanSample {
    fn default() -> Self {
        Self(Decimated::new(MOST_SCANS))
    }
}

impl ScanSample {
    /// Offers a keyframe that was taken at `robot`.
    pub(super) fn offer(&mut self, scan: &PlacedScan, robot: &Pose2<f64>) {
        let points = || {
            let at = |point: Vector2<f64>| robot.transform(&point);
            let placed = scan.points(MOST_POINTS).into_iter().map(at);
            Ok::<_, std::convert::Infallible>(placed.map(|point| (point.x, point.y)).collect())
        };
        let Ok(()) = self.0.offer(points);
    }

    /// The points in the world.
    pub(super) fn points(&self) -> Vec<(f64, f64)> {
        self.0.kept().concat()
    }
}

impl PlacedScan {
    /// At most `most` points, evenly spaced among the echoes, in the frame of the robot at the first beam.
    fn points(&self, most: usize) -> Vec<Vector2<f64>> {
        let max_range = largest_echo(&self.scan);
        let is_echo = |(_, range): &(usize, &f64)| **range > 0.0 && **range <= max_range;
        let echoes: Vec<(usize, &f64)> = self.scan.ranges.iter().enumerate().filter(is_echo).collect();
        let step = self.beam_step.map_or_else(nalgebra::Vector3::zeros, |step| step.log());
        let point = |(beam, range): &(usize, &f64)| {
            let (sin, cos) = self.scan.bearing(*beam).sin_cos();
            let laser = self.laser.compose(&Pose2::exp(&(step * *beam as f64)));
            laser.transform(&(Vector2::new(cos, sin) * **range))
        };
        echoes.iter().step_by(echoes.len().div_ceil(most).max(1)).map(point).collect()
    }
}
