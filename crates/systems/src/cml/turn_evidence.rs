use wayfix_appearance_cml::{PanoramaDescriptor, ViewDescriptor};
use wayfix_estimation_traits::wrap_angle;

/// Agreement of the turns in the views with those of the path: mean disagreement, rad, with descriptors of clockwise columns.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct AzimuthDirectionEvidence {
    /// If columns run clockwise.
    pub clockwise: f64,
    /// If columns run counterclockwise.
    pub counterclockwise: f64,
    /// If the camera does not turn.
    pub fixed: f64,
}

/// Frame distances of the compared pairs of views. Near views look alike, far views have turned.
const LAGS: [usize; 5] = [2, 4, 8, 16, 32];
/// Upper bound of a disagreement, rad; a larger one is a failed comparison.
const MOST: f64 = 0.5;
/// Smaller turns of the path may be noise and are skipped, rad.
const LEAST_TURN: f64 = 0.25;
/// Views whose distance exceeds this share of the typical distance show different places.
const ALIKE: f64 = 0.8;
/// Random turns disagree by 0.46 rad on average, with [`MOST`] as bound; those of a noisy path by half of that.
const UNRELATED: f64 = 0.35;
/// Fewer turns are not conclusive.
const ENOUGH: usize = 10;
/// Maximum number of comparisons per lag.
const N_COMPARED: usize = 400;

impl AzimuthDirectionEvidence {
    /// Whether the camera clearly never turns.
    pub(super) fn is_fixed(&self) -> bool {
        self.fixed < 0.5 * self.clockwise.min(self.counterclockwise)
    }

    /// Whether the turns of the views are unrelated to the path.
    pub(super) fn is_unrelated(&self) -> bool {
        self.fixed.min(self.clockwise).min(self.counterclockwise) > UNRELATED
    }

    /// Whether columns run counterclockwise.
    pub(super) fn is_counterclockwise(&self) -> bool {
        self.counterclockwise < self.clockwise
    }
}

/// Compares the turns between successive views with the headings of a path; `None` if too few pairs of the same place turn.
pub(super) fn turn_evidence(
    views: &[PanoramaDescriptor],
    headings: &[f64],
) -> Option<AzimuthDirectionEvidence> {
    let n = views.len().min(headings.len());
    let alike = ALIKE * typical_distance(&views[..n])?;
    let pairs = LAGS.iter().flat_map(|lag| {
        let every = (n.saturating_sub(*lag) / N_COMPARED).max(1);
        (0..n.saturating_sub(*lag)).step_by(every).map(move |from| (from, from + lag))
    });
    let mut sums = [0.0; 3];
    let mut n_turns = 0;
    for (from, to) in pairs {
        let turned = wrap_angle(headings[to] - headings[from]);
        if turned.abs() < LEAST_TURN {
            continue;
        }
        let seen = views[to].compare(&views[from]);
        if seen.distance < alike {
            let errors = [seen.rotation - turned, seen.rotation + turned, seen.rotation];
            let terms = errors.map(|error| wrap_angle(error).abs().min(MOST));
            sums.iter_mut().zip(terms).for_each(|(sum, term)| *sum += term);
            n_turns += 1;
        }
    }
    let [clockwise, counterclockwise, fixed] = sums.map(|sum| sum / n_turns.max(1) as f64);
    (n_turns >= ENOUGH).then_some(AzimuthDirectionEvidence { clockwise, counterclockwise, fixed })
}

/// The median distance of unrelated views.
fn typical_distance(views: &[PanoramaDescriptor]) -> Option<f64> {
    let half = views.len() / 2;
    let mut distances: Vec<f64> = (0..half)
        .step_by((half / 64).max(1))
        .map(|index| views[index].compare(&views[index + half]).distance)
        .collect();
    distances.sort_by(f64::total_cmp);
    distances.get(distances.len() / 2).copied()
}
