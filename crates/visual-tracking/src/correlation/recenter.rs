use super::response::Peak;
use super::tracker::CorrelationTracker;
use super::window::SIDE;
use crate::RgbImage;

/// Images after a recovery in which more of the target may become visible, a second or two.
pub(super) const N_RECENTERING_FRAMES: usize = 40;
/// Minimum gain in the share of the target's colours for a move.
const CLEARLY: f64 = 0.03;
/// Standard deviation of the move, in sides of the target.
const REACH: f64 = 0.5;

impl CorrelationTracker {
    /// Moves the box of a recently recovered target to the position with most of its colours.
    ///
    /// An occluded target is found when a part of it is visible, and a rotated one at the part that still matches. A filter learned there would
    /// keep the offset from the middle; the colours show the visible rest.
    pub(super) fn recenter(&mut self, picture: &RgbImage) {
        if self.n_recentering == 0 {
            return;
        }
        self.n_recentering -= 1;
        let window = &self.recognizer.window;
        let shares = window.box_means(&self.colors.of(&window.patch(picture, self.pose)));
        let near: Vec<f32> =
            shares.iter().zip(window.shift_prior(REACH)).map(|(share, prior)| share * prior).collect();
        let peak = Peak::of(&near, SIDE);
        if peak.value > f64::from(shares[0]) + CLEARLY {
            let pose = window.moved(self.pose, peak.shift);
            self.relearn(picture, pose, &self.recognizer.sample_at(picture, pose));
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::{BoundingBox, CorrelationTrackerParams};

    /// A checkered square of warm colours from (60, 50) on, on a checkered ground of cold ones.
    fn picture() -> RgbImage {
        let pixel = |i: usize| {
            let (u, v) = (i % 160, i / 160);
            match ((60..84).contains(&u) && (50..74).contains(&v), (u / 4 + v / 4) % 2) {
                (true, 0) => [200, 60, 40],
                (true, _) => [220, 160, 40],
                (false, 0) => [60, 90, 120],
                _ => [80, 120, 150],
            }
        };
        RgbImage::from_raw(160, 120, (0..160 * 120).flat_map(pixel).collect()).expect("3 bytes a pixel")
    }

    #[test]
    fn a_box_beside_the_middle_moves_there_while_it_settles_only() {
        let target = BoundingBox::from_corner(60.0, 50.0, 24.0, 24.0).unwrap();
        let picture = picture();
        let mut tracker =
            CorrelationTracker::new(&picture, target, CorrelationTrackerParams::default()).unwrap();
        let [u, v] = tracker.pose.center;
        tracker.pose.center = [u - 8.0, v];
        tracker.recenter(&picture);
        assert_eq!(tracker.pose.center, [u - 8.0, v], "nothing was found");
        tracker.n_recentering = N_RECENTERING_FRAMES;
        (0..3).for_each(|_| tracker.recenter(&picture));
        let off = tracker.pose.center[0] - u;
        assert!(off.abs() <= 2.0 && tracker.pose.center[1] == v, "{:?}", tracker.pose.center);
        assert_eq!(tracker.n_recentering, N_RECENTERING_FRAMES - 3);
    }
}
