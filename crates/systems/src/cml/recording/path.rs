use wayfix_estimation_traits::Pose2;

use super::{Frame, smoothed, smoothing_of};

/// Where headings come from.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Heading {
    /// The table has them.
    Given,
    /// The camera looks along the path.
    AlongPath,
    /// The camera never turns: panoramas that are aligned with a compass.
    Fixed,
    /// The camera turns on its own, and nobody knows how.
    Unknown,
}

impl Heading {
    /// What to begin with: the table's, where every frame has one, else along the path.
    pub fn of(frames: &[Frame]) -> Self {
        if frames.iter().all(|frame| frame.heading.is_some()) { Self::Given } else { Self::AlongPath }
    }
}

/// The poses of frames as they were measured, and smoothed by a Gaussian of `sigma` frames, as much as they tremble where it is not given: wheels do
/// not tremble as measurements do.
pub(in crate::cml) fn poses(
    frames: &[Frame],
    heading: Heading,
    sigma: Option<f64>,
) -> (Vec<Pose2<f64>>, Vec<Pose2<f64>>) {
    let coordinate = |axis: usize| -> Vec<f64> { frames.iter().map(|frame| frame.position[axis]).collect() };
    let (x, y) = (coordinate(0), coordinate(1));
    let sigma = sigma.unwrap_or_else(|| smoothing_of(&x, &y));
    let (x, y) = (smoothed(&x, sigma), smoothed(&y, sigma));
    let headings = match heading {
        Heading::Given => frames.iter().map(|frame| frame.heading.unwrap_or(0.0)).collect(),
        Heading::Fixed => vec![0.0; frames.len()],
        Heading::AlongPath | Heading::Unknown => tangents(&x, &y),
    };
    let measured = frames.iter().zip(&headings);
    let measured =
        measured.map(|(frame, heading)| Pose2::new(frame.position[0], frame.position[1], *heading));
    let smooth = x.iter().zip(&y).zip(&headings).map(|((x, y), heading)| Pose2::new(*x, *y, *heading));
    (measured.collect(), smooth.collect())
}

/// Directions of a path; where it stands still, that of before.
fn tangents(x: &[f64], y: &[f64]) -> Vec<f64> {
    let n = x.len();
    let ends = |index: usize| (index.saturating_sub(1), (index + 1).min(n - 1));
    let step = |(from, to): (usize, usize)| (x[to] - x[from], y[to] - y[from]);
    let mut lengths: Vec<f64> = (0..n).map(|index| step(ends(index))).map(|(dx, dy)| dx.hypot(dy)).collect();
    let standing = {
        let mut sorted = lengths.clone();
        sorted.sort_by(f64::total_cmp);
        0.1 * sorted.get(n / 2).copied().unwrap_or(0.0)
    };
    // Before the first move it looks where it will go.
    let first = lengths.iter().position(|length| *length > standing).unwrap_or(0);
    lengths.iter_mut().take(first).for_each(|length| *length = 0.0);
    let mut heading = lengths.get(first).map_or(0.0, |_| {
        let (dx, dy) = step(ends(first));
        dy.atan2(dx)
    });
    let mut headings = Vec::with_capacity(n);
    for (index, length) in lengths.iter().enumerate() {
        if *length > standing {
            let (dx, dy) = step(ends(index));
            heading = dy.atan2(dx);
        }
        headings.push(heading);
    }
    headings
}
