use std::collections::BTreeSet;

use nalgebra::{Matrix2, Vector2};
use wayfix_estimation_traits::Pose2;
use wayfix_line_extract::{HessianLine, LineEstimate, WallSegment};
use wayfix_sensor_log::TrueWall;

use super::ScanWalls;

/// Score of extracted walls against true walls, over all scans with a pose.
///
/// A segment matches the true wall nearest to both its ends, if within 0.15 m. It is within 2σ if
/// $`d^2 = Δ^T P^{-1} Δ \le 4`$ for the difference $`Δ`$ of $`(ρ, α)`$ in the sensor frame: 86.5 % of them if every covariance is correct.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct WallScore {
    /// Segments that match a true wall.
    pub n_true: usize,
    /// Segments that match no true wall.
    pub n_false: usize,
    /// Those of `n_true` within 2σ.
    pub n_within_2_sigma: usize,
    /// Sum of $`d^2`$ over `n_true`; its mean is 2 if every covariance is correct.
    pub squared_sum: f64,
    /// Visible true walls, summed over scans: at least 10 echoes within 3 cm that are nearest to this wall and span at least 0.6 m.
    pub n_visible: usize,
    /// Visible true walls without a matching segment.
    pub n_missed: usize,
}

const SAME_WALL_M: f64 = 0.15;
const ON_WALL_M: f64 = 0.03;
/// Twice the limits of [`LineExtractionParams`](wayfix_line_extract::LineExtractionParams).
const IN_SIGHT: (usize, f64) = (10, 0.6);

impl WallScore {
    /// Compares the walls of a scan with the true ones; nothing happens without a pose or without true walls.
    pub(super) fn add(&mut self, scan: &ScanWalls, truth: &[TrueWall]) {
        if let Some(pose) = scan.pose.as_ref().filter(|_| !truth.is_empty()) {
            self.add_seen(scan, &truth.iter().map(|wall| Wall::seen_from(pose, wall)).collect::<Vec<_>>());
        }
    }

    fn add_seen(&mut self, scan: &ScanWalls, truth: &[Wall]) {
        let mut found = BTreeSet::new();
        for segment in &scan.segments {
            match matching(segment, truth) {
                Some(wall) => {
                    found.insert(wall);
                    self.compare(segment, &truth[wall]);
                }
                None => self.n_false += 1,
            }
        }
        let visible_walls = visible_walls(scan, truth);
        self.n_visible += visible_walls.len();
        self.n_missed += visible_walls.iter().filter(|wall| !found.contains(wall)).count();
    }

    fn compare(&mut self, segment: &WallSegment, wall: &Wall) {
        let squared = squared_distance(segment, wall);
        self.n_true += 1;
        self.n_within_2_sigma += usize::from(squared <= 4.0);
        self.squared_sum += squared;
    }
}

/// The squared distances of the segments of a scan that match a true wall.
pub(super) fn squared_distances(scan: &ScanWalls, truth: &[TrueWall]) -> Vec<f64> {
    let Some(pose) = &scan.pose else { return Vec::new() };
    let walls: Vec<Wall> = truth.iter().map(|wall| Wall::seen_from(pose, wall)).collect();
    let squared = |segment| Some(squared_distance(segment, &walls[matching(segment, &walls)?]));
    scan.segments.iter().filter_map(squared).collect()
}

/// The true wall that a segment matches.
fn matching(segment: &WallSegment, truth: &[Wall]) -> Option<usize> {
    let apart = |wall: &Wall| wall.distance(&segment.start).max(wall.distance(&segment.end));
    nearest(truth, apart).filter(|(_, apart)| *apart < SAME_WALL_M).map(|(wall, _)| wall)
}

fn squared_distance(segment: &WallSegment, wall: &Wall) -> f64 {
    let exact = LineEstimate { line: wall.line(), covariance: Matrix2::zeros() };
    segment.estimate.mahalanobis_squared(&exact).unwrap_or(f64::INFINITY)
}

/// Walls with enough echoes on them.
fn visible_walls(scan: &ScanWalls, truth: &[Wall]) -> Vec<usize> {
    let mut places: Vec<Vec<f64>> = vec![Vec::new(); truth.len()];
    for (bearing, range) in &scan.echoes {
        let echo = Vector2::new(bearing.cos(), bearing.sin()) * *range;
        let on_wall = nearest(truth, |wall| wall.distance(&echo)).filter(|(_, apart)| *apart < ON_WALL_M);
        if let Some((wall, _)) = on_wall {
            places[wall].push(truth[wall].along(&echo));
        }
    }
    let (least_echoes, least_m) = IN_SIGHT;
    let span = |places: &[f64]| {
        let (low, high) = (places.iter().copied().reduce(f64::min), places.iter().copied().reduce(f64::max));
        high.zip(low).map_or(0.0, |(high, low)| high - low)
    };
    let is_in_sight = |wall: &usize| places[*wall].len() >= least_echoes && span(&places[*wall]) >= least_m;
    (0..truth.len()).filter(is_in_sight).collect()
}

/// The wall with the least distance, and the distance.
fn nearest(walls: &[Wall], distance: impl Fn(&Wall) -> f64) -> Option<(usize, f64)> {
    let distances = walls.iter().map(distance).enumerate();
    distances.min_by(|(_, a), (_, b)| a.total_cmp(b))
}

/// A true wall in the sensor frame.
struct Wall {
    start: Vector2<f64>,
    end: Vector2<f64>,
}

impl Wall {
    fn seen_from(pose: &Pose2<f64>, wall: &TrueWall) -> Self {
        Self { start: pose.inverse_transform(&wall.start), end: pose.inverse_transform(&wall.end) }
    }

    /// Distance along the wall from its start to the foot of a point, m.
    fn along(&self, point: &Vector2<f64>) -> f64 {
        let wall = self.end - self.start;
        (point - self.start).dot(&wall) / wall.norm()
    }

    /// Distance of a point to the wall, m.
    fn distance(&self, point: &Vector2<f64>) -> f64 {
        let wall = self.end - self.start;
        let share = (point - self.start).dot(&wall) / wall.norm_squared().max(f64::MIN_POSITIVE);
        (point - self.start - wall * share.clamp(0.0, 1.0)).norm()
    }

    fn line(&self) -> HessianLine {
        let wall = self.end - self.start;
        let normal = Vector2::new(wall.y, -wall.x) / wall.norm();
        HessianLine::new(normal.dot(&self.start), normal.y.atan2(normal.x))
    }
}

#[cfg(test)]
mod tests {
    use std::time::Duration;

    use wayfix_line_extract::{LineExtractionParams, Scan, extract};
    use wayfix_sensor_log::Stamp;

    use super::*;
    use crate::lines::totals::LineTotals;

    /// A wall 2 m ahead of a robot at (1, 1) with heading along y, seen by 61 beams `off` metres too far.
    fn scan(off: f64) -> ScanWalls {
        let step = 1_f64.to_radians();
        let bearing = |beam: usize| (beam as f64 - 30.0) * step;
        let ranges: Vec<f64> = (0..61).map(|beam| (2.0 + off) / bearing(beam).cos()).collect();
        let scan = Scan { angle_min: bearing(0), angle_increment: step, ranges: &ranges, max_range: 8.0 };
        ScanWalls {
            stamp: Stamp::default(),
            pose: Some(Pose2::new(1.0, 1.0, std::f64::consts::FRAC_PI_2)),
            echoes: ranges.iter().enumerate().map(|(beam, range)| (bearing(beam), *range)).collect(),
            segments: extract(&scan, &LineExtractionParams::default()).unwrap().segments,
            step: Duration::ZERO,
        }
    }

    fn wall(x1: f64, x2: f64) -> TrueWall {
        TrueWall { id: 0, start: Vector2::new(x1, 3.0), end: Vector2::new(x2, 3.0) }
    }

    fn score(scan: &ScanWalls, truth: &[TrueWall]) -> Option<WallScore> {
        let mut totals = LineTotals::default();
        totals.add(scan, truth);
        totals.score()
    }

    #[test]
    fn wall_in_place_is_within_two_sigma_and_a_shifted_one_not() {
        let score = |off: f64| score(&scan(off), &[wall(-9.0, 9.0)]).unwrap();
        let right = score(0.0);
        assert_eq!((right.n_true, right.n_within_2_sigma, right.n_visible, right.n_missed), (1, 1, 1, 0));
        assert!(right.squared_sum < 1e-12);
        // 61 echoes of 1 cm: 10 mm is about 7σ, and the wall still matches.
        let beside = score(0.01);
        assert_eq!((beside.n_true, beside.n_within_2_sigma, beside.n_false), (1, 0, 0));
        let elsewhere = score(0.3);
        assert_eq!((elsewhere.n_true, elsewhere.n_false, elsewhere.n_visible), (0, 1, 0));
    }

    #[test]
    fn a_wall_that_is_not_found_is_missed() {
        let blind = ScanWalls { segments: Vec::new(), ..scan(0.0) };
        let missed = score(&blind, &[wall(-9.0, 9.0)]).unwrap();
        assert_eq!((missed.n_visible, missed.n_missed), (1, 1));
        let nowhere = ScanWalls { pose: None, ..blind };
        assert_eq!(score(&nowhere, &[wall(-9.0, 9.0)]), None);
        assert_eq!(score(&scan(0.0), &[]), None);
    }
}
