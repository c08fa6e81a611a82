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
    /// Mean turn of the path, rad.
    pub turning: f64,
}

/// Frames between the two views that are compared: near ones look alike, far ones have turned.
const LAGS: [usize; 4] = [1, 2, 4, 8];
/// A larger disagreement is a comparison that went wrong, and counts as much.
const MOST: f64 = 0.5;
/// Less turning tells nothing.
const LEAST_TURNING: f64 = 0.02;
/// Comparisons of a lag; more tell nothing new.
const N_COMPARED: usize = 400;

impl TurnEvidence {
    /// Whether the camera never turns, by far.
    pub fn is_fixed(&self) -> bool {
        self.turning > LEAST_TURNING && self.fixed < 0.5 * self.clockwise.min(self.counterclockwise)
    }

    /// Whether columns go counterclockwise; clockwise where nothing tells.
    pub fn is_counterclockwise(&self) -> bool {
        self.turning > LEAST_TURNING && self.counterclockwise < self.clockwise
    }
}

/// Compares views that follow each other with the headings of a path; `None` for fewer than two.
pub fn turn_evidence(views: &[PanoramaDescriptor], headings: &[f64]) -> Option<TurnEvidence> {
    let n = views.len().min(headings.len());
    let pairs = LAGS.iter().flat_map(|lag| {
        let every = (n.saturating_sub(*lag) / N_COMPARED).max(1);
        (0..n.saturating_sub(*lag)).step_by(every).map(move |from| (from, from + lag))
    });
    let mut sums = [0.0; 4];
    let mut n_pairs = 0;
    for (from, to) in pairs {
        let seen = views[to].compare(&views[from]).rotation;
        let turned = wrap_angle(headings[to] - headings[from]);
        let terms =
            [seen - turned, seen + turned, seen, turned].map(|error| wrap_angle(error).abs().min(MOST));
        sums.iter_mut().zip(terms).for_each(|(sum, term)| *sum += term);
        n_pairs += 1;
    }
    let [clockwise, counterclockwise, fixed, turning] = sums.map(|sum| sum / f64::from(n_pairs.max(1)));
    (n_pairs > 0).then_some(TurnEvidence { clockwise, counterclockwise, fixed, turning })
}
