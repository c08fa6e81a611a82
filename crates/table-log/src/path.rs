use wayfix_estimation_traits::Pose2;

use crate::{PosedFrame, smoothed, smoothing_of};

/// Source of the headings.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum HeadingSource {
    /// The table contains them.
    Given,
    /// The camera points along the path.
    AlongPath,
    /// The camera does not turn: panoramas aligned with a compass.
    Fixed,
    /// The camera turns independently of the path; its heading is unknown.
    Unknown,
}

impl HeadingSource {
    /// The initial assumption: the table's headings if every frame has one, else along the path.
    pub fn of(frames: &[PosedFrame]) -> Self {
        if frames.iter().all(|frame| frame.heading.is_some()) { Self::Given } else { Self::AlongPath }
    }
}

/// Poses of the frames as measured, and smoothed by a Gaussian of `sigma` frames. Without `sigma`, it is estimated from the measurement noise
/// of the path.
pub fn poses(
    frames: &[PosedFrame],
    heading: HeadingSource,
    sigma: Option<f64>,
) -> (Vec<Pose2<f64>>, Vec<Pose2<f64>>) {
    let coordinate = |axis: usize| -> Vec<f64> { frames.iter().map(|frame| frame.position[axis]).collect() };
    let (x, y) = (coordinate(0), coordinate(1));
    let sigma = sigma.unwrap_or_else(|| smoothing_of(&x, &y));
    let (x, y) = (smoothed(&x, sigma), smoothed(&y, sigma));
    let headings = match heading {
        HeadingSource::Given => frames.iter().map(|frame| frame.heading.unwrap_or(0.0)).collect(),
        HeadingSource::Fixed => vec![0.0; frames.len()],
        HeadingSource::AlongPath | HeadingSource::Unknown => tangents(&x, &y),
    };
    let measured = frames.iter().zip(&headings);
    let measured =
        measured.map(|(frame, heading)| Pose2::new(frame.position[0], frame.position[1], *heading));
    let smooth = x.iter().zip(&y).zip(&headings).map(|((x, y), heading)| Pose2::new(*x, *y, *heading));
    (measured.collect(), smooth.collect())
}

/// Directions of a path; while it stands still, the last direction.
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
    // Before the first motion, use its direction.
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
