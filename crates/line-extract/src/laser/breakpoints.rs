use std::ops::Range;

use super::points::Points;
use super::{LineExtractionParams, Scan};

/// Splits the echoes where the next one is too far away to be on the same surface [Borges & Aldon 2004, adaptive breakpoint detector].
///
/// If a beam of range $`r`$ meets a surface at the angle $`λ`$, the next beam, $`Δφ`$ further, meets it at most
/// $`r \sin Δφ / \sin(λ - Δφ)`$ away; three deviations of the range are added. A larger step separates surfaces, or the angle is too small.
pub(super) fn surfaces(
    points: &Points,
    scan: &Scan,
    params: &LineExtractionParams,
    found: &mut Vec<Range<usize>>,
) {
    let reaches: Vec<f64> = (1..=params.max_missing_beams.min(scan.ranges.len()) + 1)
        .map(|beams| reach(beams as f64 * scan.angle_increment.abs(), params.breakpoint_angle_rad))
        .collect();
    let slack = 3.0 * params.beam_noise.sigma_range_m;
    found.clear();
    let mut start = 0;
    for k in 1..points.at.len() {
        let step = points.beam[k] - points.beam[k - 1];
        // Uses the nearer of the two, so that both directions split at the same point.
        let near = points.range[k].min(points.range[k - 1]);
        let together = reaches.get(step - 1).is_some_and(|reach| {
            let limit = near * reach + slack;
            (points.at[k] - points.at[k - 1]).norm_squared() <= limit * limit
        });
        if !together {
            found.push(start..k);
            start = k;
        }
    }
    if start < points.at.len() {
        found.push(start..points.at.len());
    }
}

/// The largest step relative to the range; `None` for beams too far apart to exclude a surface in between.
fn reach(turn: f64, flattest: f64) -> f64 {
    if turn < flattest { turn.sin() / (flattest - turn).sin() } else { 0.0 }
}
