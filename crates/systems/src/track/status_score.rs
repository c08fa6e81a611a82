/// A box with less overlap is off its target.
const OFF_BELOW: f64 = 0.2;
/// A box with at least this overlap is on its target. [Everingham et al. 2010]
const ON_FROM: f64 = 0.5;

/// Error rates of a tracker's lost status.
///
/// Overlap is the intersection over union of the true box and the tracker's box, also while the tracker reports the target lost. A target
/// outside the image has overlap 0.
///
/// ```
/// use wayfix_systems::track::LostStatusScore;
/// let mut score = LostStatusScore::default();
/// score.add(0.9, false); // on the target and tracked
/// score.add(0.6, true); // on the target, called lost
/// score.add(0.1, false); // off the target, called tracked
/// score.add(0.3, false); // in between: not judged
/// assert_eq!((score.false_tracked_share(), score.false_lost_share()), (1.0, 0.5));
/// ```
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct LostStatusScore {
    n_off: u64,
    n_off_tracked: u64,
    n_on: u64,
    n_on_lost: u64,
}

impl LostStatusScore {
    /// Counts a frame with an estimate.
    pub fn add(&mut self, iou: f64, is_lost: bool) {
        if iou < OFF_BELOW {
            self.n_off += 1;
            self.n_off_tracked += u64::from(!is_lost);
        } else if iou >= ON_FROM {
            self.n_on += 1;
            self.n_on_lost += u64::from(is_lost);
        }
    }

    /// Adds the counts of another run.
    pub fn merge(&mut self, other: &Self) {
        self.n_off += other.n_off;
        self.n_off_tracked += other.n_off_tracked;
        self.n_on += other.n_on;
        self.n_on_lost += other.n_on_lost;
    }

    /// Share of the frames with overlap below 0.2 that are reported as tracked; 0 without such frames.
    pub fn false_tracked_share(&self) -> f64 {
        self.n_off_tracked as f64 / self.n_off.max(1) as f64
    }

    /// Share of the frames with overlap 0.5 or more that are reported as lost; 0 without such frames.
    pub fn false_lost_share(&self) -> f64 {
        self.n_on_lost as f64 / self.n_on.max(1) as f64
    }
}
