use super::scene::{LEAST_PIXELS, Scene};
use super::{ContourTrackerParams, candidate::Candidate, reference::Reference, region::Region};
use crate::{AffineMap, BitMask, ColorQuantizer, ColorState, CondensationError, Connectivity, Picture};

/// How much smaller or larger than before a target may be when it is found again.
const AREA_RANGE: std::ops::Range<f64> = 0.4..2.5;

/// Most blobs that are looked at for one hypothesis.
const MAX_BLOBS: usize = 4;

impl<'a> Scene<'a> {
    /// The whole picture; nothing is known of the place. What is common in all of it counts as background.
    pub(super) fn whole(
        params: &'a ContourTrackerParams,
        quantizer: &'a ColorQuantizer,
        picture: &'a Picture,
        reference: &'a Reference,
    ) -> Result<Self, CondensationError> {
        let region = Region::whole(picture, quantizer)?;
        let everywhere = BitMask::full(picture.width(), picture.height())?;
        let mut background = region.shares(&everywhere);
        background.iter_mut().for_each(|share| *share *= params.background_odds as f32);
        Ok(Self {
            params,
            quantizer,
            picture,
            reference,
            region,
            start: *reference.snake.map(),
            expected: everywhere,
            expected_area: reference.steady_area,
            background,
        })
    }

    /// The best blob of a hypothesis, anywhere.
    pub(super) fn find(&self, state: &ColorState) -> Option<(Candidate, BitMask)> {
        let blobs = self.segment(&self.bin_set(state)).blobs(Connectivity::Eight);
        let ratio = |area: usize| area as f64 / self.expected_area;
        let mut near: Vec<(usize, f64)> = blobs
            .iter()
            .enumerate()
            .filter(|(_, blob)| blob.area >= LEAST_PIXELS && AREA_RANGE.contains(&ratio(blob.area)))
            .map(|(i, blob)| (i, ratio(blob.area).ln().abs()))
            .collect();
        near.sort_by(|a, b| a.1.total_cmp(&b.1));
        let weigh = |&(i, _): &(usize, f64)| {
            let mask = blobs.mask(i)?;
            Some((self.placed_on(&mask), mask))
        };
        let candidates = near.iter().take(MAX_BLOBS).filter_map(weigh);
        candidates.reduce(|best, other| if self.score(&other.0) > self.score(&best.0) { other } else { best })
    }

    pub(super) fn score(&self, candidate: &Candidate) -> f64 {
        candidate.agreement.score(self.params)
    }

    /// The snake laid on a blob, of its size, and fitted.
    fn placed_on(&self, mask: &BitMask) -> Candidate {
        let last = self.reference.snake.map();
        let scale = (mask.area() as f64 / self.reference.snake.area_at(last)).sqrt();
        let translation = mask.centroid().unwrap_or_default().into();
        Candidate::of_mask(self, &AffineMap { linear: last.linear * scale, translation }, mask)
    }
}
