use std::cmp::Ordering;

use nalgebra::{Vector2, linalg::Cholesky};
use wayfix_estimation_traits::{Manifold, Pose2};
use wayfix_sensor_log::{Record, RecordData, TrueWall};
use wayfix_slam_ekf::{LandmarkEstimate, Wall, WallLine};

/// The true walls of a log, in its order.
pub(super) fn true_walls(records: &[Record]) -> Vec<TrueWall> {
    let wall = |record: &Record| match record.data {
        RecordData::TrueWall(wall) => Some(wall),
        _ => None,
    };
    records.iter().filter_map(wall).collect()
}

/// The wall as a landmark.
pub(super) fn landmark(wall: &TrueWall) -> Wall {
    let along = wall.end - wall.start;
    let normal = Vector2::new(along.y, -along.x) / along.norm();
    let line = WallLine::new(normal.dot(&wall.start), normal.y.atan2(normal.x));
    Wall::between(line, [wall.start, wall.end])
}

/// The true walls of at least two metres that are nearest to a pose.
pub(super) fn nearest_to<'a>(pose: &Pose2<f64>, walls: &'a [TrueWall], n: usize) -> Vec<&'a TrueWall> {
    const LONG: f64 = 2.0;
    let distance = |wall: &TrueWall| {
        let along = wall.end - wall.start;
        let share = (pose.translation - wall.start).dot(&along) / along.norm_squared();
        (wall.start + along * share.clamp(0.0, 1.0) - pose.translation).norm()
    };
    let mut long: Vec<&TrueWall> =
        walls.iter().filter(|wall| (wall.end - wall.start).norm() >= LONG).collect();
    long.sort_by(|a, b| distance(a).partial_cmp(&distance(b)).unwrap_or(Ordering::Equal));
    long.truncate(n);
    long
}

/// How far an estimated wall is from the true one that it must be, squared and in units of its covariance; chi-squared with two degrees of
/// freedom for an honest filter. `None` when there is no true wall within half a metre and ten degrees beside its middle.
pub(super) fn nees(estimate: &LandmarkEstimate<Wall>, truth: &[TrueWall]) -> Option<f64> {
    let [start, end] = estimate.mean.ends();
    let middle = (start + end) * 0.5;
    let errors = truth.iter().map(landmark).filter_map(|wall| {
        let error = estimate.mean.local(&wall);
        let from_origin = middle - wall.origin;
        let beside = (wall.line.normal().dot(&from_origin) - wall.line.rho).abs();
        let [from, to] = wall.stretch;
        let is_it = beside < LARGEST_OFFSET
            && error.y.abs() < LARGEST_TURN
            && (from..=to).contains(&wall.line.along(&from_origin));
        is_it.then_some((beside, error))
    });
    let (_, error) = errors.min_by(|a, b| a.0.total_cmp(&b.0))?;
    Some(error.dot(&Cholesky::new(estimate.covariance)?.solve(&error)))
}

/// Half of what separates the two sides of a room's smallest recess.
const LARGEST_OFFSET: f64 = 0.5;
/// Ten degrees.
const LARGEST_TURN: f64 = 0.1745;
