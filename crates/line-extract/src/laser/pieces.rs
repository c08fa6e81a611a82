//! Straight pieces of a surface.

use std::ops::Range;

use nalgebra::Vector2;

use super::curvature_test::CurvatureTest;
use super::points::Points;
use super::{LineExtractionParams, SplitMethod};
use crate::line::Moments;
use crate::simplify::{PolylineSimplifier, first_max};
use crate::{LineEstimate, LineExtractionError};

/// A straight piece while it may still grow.
#[derive(Clone, Debug)]
pub(super) struct Piece {
    pub(super) moments: Moments,
    pub(super) estimate: LineEstimate,
    /// The outermost points, in the line's direction.
    pub(super) ends: [Vector2<f64>; 2],
    pub(super) beams: (usize, usize),
    pub(super) bend: CurvatureTest,
}

/// The indices where a surface is split, its ends included.
pub(super) fn split(
    surface: &[Vector2<f64>],
    params: &LineExtractionParams,
    simplifier: &mut PolylineSimplifier,
    corners: &mut Vec<usize>,
) -> Result<(), LineExtractionError> {
    match params.split_method {
        SplitMethod::EndPointFit => simplifier.simplify_into(surface, params.split_distance_m, corners)?,
        SplitMethod::SplitAndMerge => simplifier.split_where(surface.len(), corners, |start, end| {
            off_the_fit(surface, start, end, params.split_distance_m)
        }),
    }
    Ok(())
}

/// Split index for residuals of the fitted line: the point farthest from it, or, if that is an end, from the line through the ends.
fn off_the_fit(surface: &[Vector2<f64>], start: usize, end: usize, limit: f64) -> Option<usize> {
    let line = Moments::new(&surface[start..=end], |_| 1.0).line().ok()?.line;
    let distance = |k: usize| line.signed_distance(&surface[k]).abs();
    let farthest = first_max(start..end + 1, distance)?;
    if distance(farthest) <= limit {
        return None;
    }
    if start < farthest && farthest < end {
        return Some(farthest);
    }
    let chord = surface[end] - surface[start];
    first_max(start + 1..end, |k| chord.perp(&(surface[k] - surface[start])).abs())
}

impl Piece {
    /// Fits a line to neighbouring echoes, without points at the ends that belong to the next wall; `None` if too few points remain.
    pub(super) fn fit(
        points: &Points,
        mut range: Range<usize>,
        params: &LineExtractionParams,
    ) -> Option<Self> {
        let noise = &params.beam_noise;
        let moments = |range: &Range<usize>, normal: &Vector2<f64>| {
            let part = &points.at[range.clone()];
            Moments::new(part, |k| noise.weight(&part[k], normal))
        };
        if range.len() < LEAST {
            return None;
        }
        let chord = points.at[range.end - 1] - points.at[range.start];
        let across = Vector2::new(-chord.y, chord.x).try_normalize(0.0)?;
        let line = moments(&range, &across).line().ok()?.line;
        let normal = line.normal();
        let fits = |k: usize| {
            let p = &points.at[k];
            let off = normal.dot(p) - line.rho();
            off * off * noise.weight(p, &normal)
                <= params.end_point_gate_sigmas * params.end_point_gate_sigmas
        };
        range.start = range.clone().find(|k| fits(*k))?;
        range.end = range.clone().rev().find(|k| fits(*k))? + 1;
        if range.len() < LEAST {
            return None;
        }
        let moments = moments(&range, &normal);
        let estimate = moments.line().ok()?;
        let bend = CurvatureTest::of(&points.at[range.clone()], &estimate, noise, params.bulge_sigma_m);
        let (first, last) = (range.start, range.end - 1);
        let ends = outermost(&estimate, [points.at[first], points.at[last]]);
        Some(Self { moments, estimate, ends, bend, beams: (points.beam[first], points.beam[last]) })
    }
}

/// The first and the last of points along a line.
pub(super) fn outermost<const N: usize>(on: &LineEstimate, points: [Vector2<f64>; N]) -> [Vector2<f64>; 2] {
    let direction = on.line.direction();
    points.iter().fold([points[0]; 2], |[first, last], p| {
        let along = direction.dot(p);
        [
            if along < direction.dot(&first) { *p } else { first },
            if along > direction.dot(&last) { *p } else { last },
        ]
    })
}

/// Two points fit every line.
const LEAST: usize = 3;
