use super::{
    TrackingCues, hypotheses::candidate::Candidate, recolor::SEEN_ALL_ROUND, refine::COVERED, scene::Scene,
};
use crate::{PixelMask, TrackingError};

/// Least support and overlap of a certain larger contour.
const BEYOND_DOUBT: f64 = 0.9;

/// Maximum ratio of the new to the expected area.
const MOST_GROWTH: f64 = 2.5;

impl Candidate {
    /// A contour around a whole blob of which the current contour has lost a part; `None` without evidence for it.
    ///
    /// A quick change of light can exclude a part of the target. The contour then fits the edge of the light, and its area becomes the
    /// expected one, so it stays there after the light is even again. Signs of this are a side without an edge and a blob that continues beyond
    /// it. Other objects of the target's colours beside it do not match its shape.
    pub(super) fn regrown(&self, scene: &Scene<'_>, mask: &PixelMask) -> Result<Option<Self>, TrackingError> {
        let blob = mask.area() as f64;
        let may_have_shrunk = scene.params.cues == TrackingCues::ColorAndShape
            && self.agreement.affine < SEEN_ALL_ROUND
            && self.area < blob
            && blob < MOST_GROWTH * scene.expected_area;
        if !may_have_shrunk || scene.coverage(self, mask)? >= COVERED {
            return Ok(None);
        }
        let Some(larger) = scene.placed_on(mask) else { return Ok(None) };
        let is_sure =
            larger.agreement.affine >= BEYOND_DOUBT && scene.coverage(&larger, mask)? >= BEYOND_DOUBT;
        Ok(is_sure.then_some(larger))
    }
}

#[cfg(test)]
mod tests {
    use rand::SeedableRng;
    use rand_chacha::ChaCha8Rng;

    use crate::{ColorContourTracker, PixelMask, RgbImage, Tracker};

    const SIZE: (usize, usize) = (140, 110);

    fn in_rectangle(u: usize, v: usize, (left, right): (usize, usize)) -> bool {
        (left..right).contains(&u) && (35..75).contains(&v)
    }

    /// The overlap with `truth` of the contour that began on `start` and saw the picture of `red` things three times.
    fn tracked(
        red: impl Fn(usize, usize) -> bool,
        start: impl Fn(usize, usize) -> bool,
        truth: impl Fn(usize, usize) -> bool,
    ) -> f64 {
        let pixel = |i: usize| if red(i % SIZE.0, i / SIZE.0) { [190, 60, 50] } else { [90, 110, 90] };
        let picture =
            RgbImage::from_raw(SIZE.0 as u32, SIZE.1 as u32, (0..SIZE.0 * SIZE.1).flat_map(pixel).collect())
                .expect("3 bytes a pixel");
        let mask = |f: &dyn Fn(usize, usize) -> bool| PixelMask::from_fn(SIZE.0, SIZE.1, f).expect("size");
        let mut tracker =
            ColorContourTracker::from_mask(&picture, &mask(&start), Default::default()).expect("a target");
        let mut rng = ChaCha8Rng::seed_from_u64(1);
        for _ in 0..3 {
            tracker.track(&picture, &mut rng).expect("the size of the first");
        }
        let outline = tracker.snake().outline();
        let contour = PixelMask::from_polygon(SIZE.0, SIZE.1, outline.points()).expect("size");
        contour.iou(&mask(&truth)).expect("size")
    }

    #[test]
    fn a_contour_that_lost_a_part_of_its_target_takes_it_back() {
        let whole = |u, v| in_rectangle(u, v, (40, 100));
        let part = |u, v| in_rectangle(u, v, (70, 100));
        let overlap = tracked(whole, part, whole);
        assert!(overlap > 0.9, "half at the start, {overlap} at the end");
    }

    #[test]
    fn what_sticks_out_of_a_target_stays_outside() {
        let body = |u, v| in_rectangle(u, v, (60, 100));
        let with_neck = |u, v| body(u, v) || ((30..60).contains(&u) && (48..60).contains(&v));
        let overlap = tracked(with_neck, body, body);
        assert!(overlap > 0.9, "{overlap}");
    }
}
