use std::time::Duration;

use wayfix_sensor_log::TrueWall;

use super::{ScanWalls, WallScore};

/// Sums over the scans of a log, so that no scan need be kept.
#[derive(Clone, Debug, Default)]
pub(super) struct LineTotals {
    /// Number of processed scans.
    pub(super) n_used: usize,
    /// Number of walls, summed over the scans.
    pub(super) n_segments: usize,
    /// Computing time.
    pub(super) time: Duration,
    /// Echoes on walls, and the sum of their squared distances, m².
    residuals: (f64, f64),
    score: WallScore,
}

impl LineTotals {
    pub(super) fn add(&mut self, scan: &ScanWalls, truth: &[TrueWall]) {
        self.n_used += 1;
        self.n_segments += scan.segments.len();
        self.time += scan.step;
        for segment in &scan.segments {
            let n_points = segment.n_points as f64;
            self.residuals.0 += n_points;
            self.residuals.1 += n_points * segment.rms_m.powi(2);
        }
        self.score.add(scan, truth);
    }

    /// RMS distance of the echoes from the walls fitted to them, m.
    pub(super) fn residual_rms(&self) -> Option<f64> {
        let (n_points, sum) = self.residuals;
        (n_points > 0.0).then(|| (sum / n_points).sqrt())
    }

    /// The score against the true walls that the log gave before the scans; `None` if there was nothing to compare.
    pub(super) fn score(&self) -> Option<WallScore> {
        let WallScore { n_true, n_false, n_visible, .. } = self.score;
        (n_true + n_false + n_visible > 0).then_some(self.score)
    }
}
