use nalgebra::Vector2;
use wayfix_estimation_traits::Pose2;

use super::Decimated;

/// Scans of which points are kept.
const MOST_SCANS: usize = 256;
/// Points that are kept of a scan.
const MOST_POINTS: usize = 90;

/// Some points of some scans for the picture of a map, evenly spaced, at the poses that were estimated then. Memory does not grow with the log.
pub struct ScanSample(Decimated<Vec<(f64, f64)>>);

impl Default for ScanSample {
    fn default() -> Self {
        Self(Decimated::new(MOST_SCANS))
    }
}

impl ScanSample {
    /// Offers a scan, whose points are in the frame of the robot at `robot`.
    pub fn offer(&mut self, points: &[Vector2<f64>], robot: &Pose2<f64>) {
        let stride = points.len().div_ceil(MOST_POINTS).max(1);
        let points = points.iter().step_by(stride).map(|point| robot.transform(point));
        self.0.push(points.map(|point| (point.x, point.y)).collect());
    }

    /// The points in the world.
    pub fn points(&self) -> Vec<(f64, f64)> {
        self.0.kept().concat()
    }
}
