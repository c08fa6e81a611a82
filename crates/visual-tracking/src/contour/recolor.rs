use super::{TrackingCues, hypotheses::candidate::Candidate, scene::Scene};
use crate::StructuringElement;
use crate::picture::rgb_pixels;
use crate::{ColorBinSet, ColorCloud, PixelMask, TrackingError};

/// Share of the expected area that the pixels of a new colour set must have.
const LEAST_SHARE: f64 = 0.25;

/// Support of a contour from which on the target counts as unoccluded.
pub(super) const SEEN_ALL_ROUND: f64 = 0.8;

impl Scene<'_> {
    /// The colours inside the contour of the best candidate; `None` if there are too few pixels.
    ///
    /// Pixels at the rim are mixed with the background and excluded. With a background model, bins more frequent outside are excluded too. Unless
    /// almost the whole contour is visible, so are bins that do not touch one of the best hypothesis, because they may belong to an occluder.
    pub(super) fn colors_of(
        &self,
        candidate: &Candidate,
        set: &ColorBinSet,
        mask: &PixelMask,
    ) -> Result<Option<ColorCloud>, TrackingError> {
        let inside = self.interior(candidate, mask)?;
        let n_expected = LEAST_SHARE * self.expected_area;
        let plain = self.params.min_target_to_background_ratio == 0.0;
        let shares = self.region.shares(&inside);
        let is_open = candidate.agreement.affine >= SEEN_ALL_ROUND;
        let near = set.dilated(self.quantizer);
        let is_target = |bin: u16| {
            let i = usize::from(bin);
            plain || (shares[i] > self.background[i] && (is_open || near.contains(bin)))
        };
        let colors = self.colors_in(&inside).filter(|(bin, _)| is_target(*bin)).map(|(_, color)| color);
        match ColorCloud::from_colors(colors, self.params.max_color_points) {
            Ok(cloud) if cloud.n_pixels() >= n_expected => Ok(Some(cloud)),
            Ok(_) | Err(TrackingError::Empty { .. }) => Ok(None),
            Err(error) => Err(error),
        }
    }

    /// Bin and colour of every pixel of a mask of the region.
    pub(super) fn colors_in(&self, mask: &PixelMask) -> impl Iterator<Item = (u16, [f64; 3])> {
        let ((left, top), width) = (self.region.rect.corner(), self.picture.width() as usize);
        let pixels = mask.runs().flat_map(|(v, run)| run.map(move |u| (u, v)));
        pixels.map(move |(u, v)| {
            let bin = self.region.bins.bins()[v * self.region.bins.width() + u];
            let color = rgb_pixels(self.picture)[(top + v) * width + left + u];
            (bin, self.params.color_space.convert(color))
        })
    }

    /// The pixels inside a candidate but for its rim.
    pub(super) fn interior(
        &self,
        candidate: &Candidate,
        mask: &PixelMask,
    ) -> Result<PixelMask, TrackingError> {
        let inside = match self.params.cues {
            TrackingCues::Color => mask.clone(),
            _ => self.region.inside(self.reference.snake.outline_at(&candidate.map)?.points())?,
        };
        let core = inside.eroded(StructuringElement::Square { radius: 1 });
        Ok(if 2 * core.area() >= inside.area() { core } else { inside })
    }
}
