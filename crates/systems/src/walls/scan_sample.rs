use wayfix_estimation_traits::Pose2;
use wayfix_evaluation::plot::Decimated;
use wayfix_scan_match::ScanPointCloud;

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
    /// Offers a keyframe, whose points are in the frame of the robot at `robot`.
    pub(super) fn offer(&mut self, cloud: &ScanPointCloud, robot: &Pose2<f64>) {
        let stride = cloud.points().len().div_ceil(MOST_POINTS).max(1);
        let points = cloud.points().iter().step_by(stride).map(|point| robot.transform(point));
        self.0.push(points.map(|point| (point.x, point.y)).collect());
    }

    /// The points in the world.
    pub(super) fn points(&self) -> Vec<(f64, f64)> {
        self.0.kept().concat()
    }
}
