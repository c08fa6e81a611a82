use nalgebra::{Isometry2, Point2, Vector2};

use super::{BeamCounts, Scan};

/// The echoes of a scan as points, with room that is used again.
#[derive(Clone, Debug, Default)]
pub(super) struct Points {
    pub(super) at: Vec<Vector2<f64>>,
    pub(super) range: Vec<f64>,
    pub(super) beam: Vec<usize>,
    rays: Vec<Vector2<f64>>,
    /// First bearing and increment of the rays.
    geometry: (f64, f64),
}

impl Points {
    /// Turns valid ranges into points and counts the others.
    pub(super) fn fill(&mut self, scan: &Scan, counts: &mut BeamCounts) {
        self.aim(scan);
        self.at.clear();
        self.range.clear();
        self.beam.clear();
        for (beam, (&range, ray)) in scan.ranges.iter().zip(&self.rays).enumerate() {
            if range > 0.0 && range <= scan.max_range {
                self.at.push(ray * range);
                self.range.push(range);
                self.beam.push(beam);
            } else {
                *reason(range, counts) += 1;
            }
        }
        counts.valid = self.at.len();
    }

    /// Transforms each echo to the frame of the first beam, if the sensor moves by `step` from beam to beam.
    pub(super) fn deskew(&mut self, step: &Isometry2<f64>) {
        let mut sensor = Isometry2::identity();
        let mut at_beam = 0;
        for (at, &beam) in self.at.iter_mut().zip(&self.beam) {
            while at_beam < beam {
                sensor *= step;
                at_beam += 1;
            }
            *at = (sensor * Point2::from(*at)).coords;
        }
    }

    /// Sines and cosines take longer than everything else, and the next scan has the same.
    fn aim(&mut self, scan: &Scan) {
        let geometry = (scan.angle_min, scan.angle_increment);
        if geometry != self.geometry {
            self.rays.clear();
            self.geometry = geometry;
        }
        for beam in self.rays.len()..scan.ranges.len() {
            let (sin, cos) = (scan.angle_min + beam as f64 * scan.angle_increment).sin_cos();
            self.rays.push(Vector2::new(cos, sin));
        }
    }
}

/// Reason why a range is no echo.
fn reason(range: f64, counts: &mut BeamCounts) -> &mut usize {
    if range.is_nan() {
        &mut counts.nan
    } else if range.is_infinite() {
        &mut counts.infinite
    } else if range <= 0.0 {
        &mut counts.not_positive
    } else {
        &mut counts.beyond_max
    }
}
