use super::{ColorContourTrackerParams, reference::Reference, region::Region};
use crate::StructuringElement;
use crate::{
    AffineMap, ColorBinSet, ColorDistributionState, ColorQuantizer, PixelConnectivity, PixelMask, RgbImage,
    TrackingError,
};

/// Data shared by all hypotheses about one image.
pub(super) struct Scene<'a> {
    pub(super) params: &'a ColorContourTrackerParams,
    pub(super) quantizer: &'a ColorQuantizer,
    pub(super) picture: &'a RgbImage,
    pub(super) reference: &'a Reference,
    pub(super) region: Region,
    /// Initial map of the snake.
    pub(super) start: AffineMap,
    /// The pixels that the target is expected to cover.
    pub(super) expected: PixelMask,
    pub(super) expected_area: f64,
    /// For every bin, the share that it must exceed among the colours of the target.
    pub(super) background: Vec<f32>,
}

/// Minimum distance in pixels from the expected target to the edge of the region and to the background.
const LEAST_MARGIN: f64 = 8.0;

/// Pixels of the smallest target.
pub(super) const LEAST_PIXELS: usize = 4;

impl<'a> Scene<'a> {
    /// The region around the expected target; `None` if that is outside the image.
    pub(super) fn around_target(
        params: &'a ColorContourTrackerParams,
        quantizer: &'a ColorQuantizer,
        picture: &'a RgbImage,
        reference: &'a Reference,
    ) -> Result<Option<Self>, TrackingError> {
        let start = reference.expected_map();
        let outline = reference.snake.outline_at(&start)?;
        let radius = (outline.area() / std::f64::consts::PI).sqrt();
        let margin = (0.75 * radius).max(2.0 * LEAST_MARGIN);
        let Some(region) = Region::around(picture, quantizer, &outline.bounding_box(), margin)? else {
            return Ok(None);
        };
        let expected = region.inside(outline.points())?;
        let near = expected
            .dilated(StructuringElement::Square { radius: (0.25 * radius).max(LEAST_MARGIN / 2.0) as usize });
        let mut background = region.shares(&near.not());
        background.iter_mut().for_each(|share| *share *= params.min_target_to_background_ratio as f32);
        let expected_area =
            reference.expected_area(params.extrapolated_area_change_share, params.mean_area_weight);
        Ok(Some(Self {
            params,
            quantizer,
            picture,
            reference,
            region,
            start,
            expected,
            expected_area,
            background,
        }))
    }

    /// The target's bins under a hypothesis: those that contain colours, more of them than the background.
    pub(super) fn bin_set(&self, state: &ColorDistributionState) -> ColorBinSet {
        let warp = state.warp_from(&self.reference.colors);
        let total = self.reference.cloud.n_pixels() as f32;
        let warped = self.reference.cloud.warped(&warp);
        let mut counts: Vec<(u16, f32)> = warped
            .filter_map(|(color, count)| Some((self.quantizer.bin_of_point(color.into())?, count as f32)))
            .collect();
        counts.sort_unstable_by_key(|(bin, _)| *bin);
        let mut set = ColorBinSet::empty(self.quantizer);
        for same in counts.chunk_by(|a, b| a.0 == b.0) {
            let share = same.iter().map(|(_, count)| count).sum::<f32>() / total;
            if share > self.background[usize::from(same[0].0)] {
                set.insert(same[0].0);
            }
        }
        set
    }

    /// The target in the segmentation by a set of bins: the blob with the largest overlap with the expected position, and those whose centre
    /// lies in the expected target.
    pub(super) fn target_mask(&self, set: &ColorBinSet) -> Option<PixelMask> {
        let blobs = self.segment(set).blobs(PixelConnectivity::Eight);
        let main = blobs.most_overlapping(&self.expected).expect("invariant: one region for all")?;
        let mut index = 0..;
        let mask = blobs.filtered(|blob| {
            let middle = (blob.rect.left + blob.rect.width / 2, blob.rect.top + blob.rect.height / 2);
            index.next() == Some(main) || self.expected.get(middle.0, middle.1)
        });
        (mask.area() >= LEAST_PIXELS).then_some(mask)
    }

    /// The pixels of a set of bins, after closing and opening.
    pub(super) fn segment(&self, set: &ColorBinSet) -> PixelMask {
        let mask = self.region.segment(set);
        match self.params.morphology_radius {
            0 => mask,
            radius => mask
                .closed(StructuringElement::Square { radius })
                .opened(StructuringElement::Square { radius }),
        }
    }
}
