use super::{TrackingCues, candidate::Candidate, scene::Scene};
use crate::tracking::Element;
use crate::{BinSet, BitMask, ColorCloud, CondensationError};

/// Share of the expected area that the pixels of a new colour set must have.
const LEAST_SHARE: f64 = 0.25;

/// Support of a contour from which on nothing covers the target.
const SEEN_ALL_ROUND: f64 = 0.8;

impl Scene<'_> {
    /// The colours inside the contour of the best candidate; none when there are too few pixels to tell.
    ///
    /// Pixels at the rim are mixed with the background and left out. With a background model so are bins that are more frequent outside,
    /// and, unless the contour is seen nearly all round, bins that do not touch one of the best hypothesis: they may be of what covers the
    /// target.
    pub(super) fn colors_of(
        &self,
        candidate: &Candidate,
        set: &BinSet,
        mask: &BitMask,
    ) -> Result<Option<ColorCloud>, CondensationError> {
        let inside = self.interior(candidate, mask)?;
        let n_expected = LEAST_SHARE * self.expected_area;
        let plain = self.params.background_odds == 0.0;
        let shares = self.region.shares(&inside);
        let is_open = candidate.agreement.affine >= SEEN_ALL_ROUND;
        let near = set.dilated(self.quantizer);
        let is_target = |bin: u16| {
            let i = usize::from(bin);
            plain || (shares[i] > self.background[i] && (is_open || near.contains(bin)))
        };
        let (left, top) = self.region.rect.corner();
        let pixel = |u: usize, v: usize| self.picture.pixels()[(top + v) * self.picture.width() + left + u];
        let colors = self.region.bins.rows().enumerate().flat_map(|(v, row)| {
            let (inside, is_target) = (&inside, &is_target);
            let of_target =
                row.iter().enumerate().filter(move |(u, bin)| inside.get(*u, v) && is_target(**bin));
            of_target.map(move |(u, _)| self.params.color_space.convert(pixel(u, v)))
        });
        match ColorCloud::from_colors(colors, self.params.max_colors) {
            Ok(cloud) if cloud.n_pixels() >= n_expected => Ok(Some(cloud)),
            Ok(_) | Err(CondensationError::Empty { .. }) => Ok(None),
            Err(error) => Err(error),
        }
    }

    /// The pixels inside a candidate but for its rim.
    fn interior(&self, candidate: &Candidate, mask: &BitMask) -> Result<BitMask, CondensationError> {
        let inside = match self.params.cues {
            TrackingCues::Color => mask.clone(),
            _ => self.region.inside(self.reference.snake.outline_at(&candidate.map)?.points())?,
        };
        let core = inside.eroded(Element::Square { radius: 1 });
        Ok(if 2 * core.area() >= inside.area() { core } else { inside })
    }
}
