use wayfix_appearance_cml::{Descriptor, PanoramaDescriptor};
use wayfix_estimation_traits::wrap_angle;

/// How well the turns that views show agree with those of a path: the mean disagreement, rad, of views described with clockwise columns.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct TurnEvidence {
    /// When columns go clockwise.
    pub clockwise: f64,
    /// When they go counterclockwise.
    pub counterclockwise: f64,
    /// When the camera does not turn at all.
    pub fixed: f64,
}

/// Frames between the two views that are compared: near ones look alike, far ones have turned.
const LAGS: [usize; 5] = [2, 4, 8, 16, 32];
/// A larger disagreement is a comparison that went wrong, and counts as much, rad.
const MOST: f64 = 0.5;
/// A smaller turn is as likely to be a trembling of the path, rad.
const LEAST_TURN: f64 = 0.25;
/// Views that differ by more than this share of what views of anywhere differ by are not of the same place.
const ALIKE: f64 = 0.8;
/// Turns at random disagree by 0.46 rad in the mean, with what [`MOST`] cuts off; those of a path that trembles by half of that.
const UNRELATED: f64 = 0.35;
/// Fewer turns tell nothing.
const ENOUGH: usize = 10;
/// Comparisons of a lag; more tell nothing new.
const N_COMPARED: usize = 400;

impl TurnEvidence {
    /// Whether the camera never turns, by far.
    pub fn is_fixed(&self) -> bool {
        self.fixed < 0.5 * self.clockwise.min(self.counterclockwise)
    }

    /// Whether the views turn in ways that have nothing to do with the path.
    pub fn is_unrelated(&self) -> bool {
        self.fixed.min(self.clockwise).min(self.counterclockwise) > UNRELATED
    }

    /// Whether columns go counterclockwise.
    pub fn is_counterclockwise(&self) -> bool {
        self.counterclockwise < self.clockwise
    }
}

/// Compares views that follow each other with the headings of a path; `None` where too few views of the same place have turned.
pub fn turn_evidence(views: &[PanoramaDescriptor], headings: &[f64]) -> Option<TurnEvidence> {
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
    (n_turns >= ENOUGH).then_some(TurnEvidence { clockwise, counterclockwise, fixed })
}

/// The median distance of views that have nothing to do with each other.
fn typical_distance(views: &[PanoramaDescriptor]) -> Option<f64> {
    let half = views.len() / 2;
    let mut distances: Vec<f64> = (0..half)
        .step_by((half / 64).max(1))
        .map(|index| views[index].compare(&views[index + half]).distance)
        .collect();
    distances.sort_by(f64::total_cmp);
    distances.get(distances.len() / 2).copied()
}
