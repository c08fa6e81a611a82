use nalgebra::{Matrix2, Vector2, Vector3};

use super::scene::{LEAST_PIXELS, Scene};
use super::{
    ColorContourTrackerParams, hypotheses::candidate::Candidate, reference::Reference, region::Region,
};
use crate::{
    AffineMap, AffineSnake, ColorDistributionState, ColorQuantizer, ColorSpace, PixelConnectivity, PixelMask,
    PrincipalColors, RgbImage, TrackingError,
};

/// Allowed ratio of the area to the previous one, for a target found again.
const AREA_RANGE: std::ops::Range<f64> = 0.4..2.5;

/// Maximum stretch of one side of a target, relative to its change in size.
const MAX_STRETCH: f64 = 1.4;

/// Number of light intensities to try above the last one, and the same below: steps of a fifth.
const N_GAINS: i32 = 6;

/// Maximum number of blobs tested per hypothesis.
const MAX_BLOBS: usize = 4;

/// A blob that may be the target.
pub(super) struct BlobCandidate {
    pub(super) candidate: Candidate,
    pub(super) mask: PixelMask,
    pub(super) score: f64,
}

impl<'a> Scene<'a> {
    /// The whole image, without a prior position. Colours frequent in all of it count as background.
    pub(super) fn whole(
        params: &'a ColorContourTrackerParams,
        quantizer: &'a ColorQuantizer,
        picture: &'a RgbImage,
        reference: &'a Reference,
    ) -> Result<Self, TrackingError> {
        let region = Region::whole(picture, quantizer)?;
        let everywhere = PixelMask::full(picture.width() as usize, picture.height() as usize)?;
        let mut background = region.shares(&everywhere);
        background.iter_mut().for_each(|share| *share *= params.min_target_to_background_ratio as f32);
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

    /// The best blob of a hypothesis, anywhere, by its score times the similarity of its colours.
    pub(super) fn find(&self, state: &ColorDistributionState) -> Option<BlobCandidate> {
        let blobs = self.segment(&self.bin_set(state)).blobs(PixelConnectivity::Eight);
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
            let candidate = self.placed_on(&mask)?;
            let score = self.score(&candidate) * self.color_similarity(state, &candidate, &mask).ok()?;
            Some(BlobCandidate { candidate, mask, score })
        };
        let candidates = near.iter().take(MAX_BLOBS).filter_map(weigh);
        candidates.reduce(|best, other| if other.score > best.score { other } else { best })
    }

    fn score(&self, candidate: &Candidate) -> f64 {
        candidate.agreement.score(self.params)
    }

    /// Fits the snake to a blob from each of the [`placements`].
    pub(super) fn placed_on(&self, mask: &PixelMask) -> Option<Candidate> {
        let fitted = placements(&self.reference.snake, mask, self.region.rect.corner());
        let fitted = fitted.iter().map(|start| Candidate::of_mask(self, start, mask));
        fitted.reduce(|best, other| if self.score(&other) > self.score(&best) { other } else { best })
    }
}

/// Initial maps of a snake on a blob of a region with this corner: centred, of equal area, with unchanged orientation; and with the axes
/// aligned with those of the blob, in both directions, stretched like the blob within bounds.
fn placements(snake: &AffineSnake, mask: &PixelMask, corner: (usize, usize)) -> Vec<AffineMap> {
    let last = snake.map();
    let scale = (mask.area() as f64 / snake.area_at(last)).sqrt();
    let [u, v] = mask.centroid().unwrap_or_default();
    let middle = Vector2::new(u + corner.0 as f64, v + corner.1 as f64);
    let pixels = mask.outer_contour();
    let rim: Vec<[f64; 2]> = pixels.iter().map(|pixel| pixel.map(|x| x as f64)).collect();
    let (to, to_spread) = axes(&rim);
    let (from, from_spread) = axes(snake.outline().points());
    let stretch = to_spread.zip_map(&from_spread, |to, from| {
        scale * (to / (scale * from.max(f64::MIN_POSITIVE))).clamp(1.0 / MAX_STRETCH, MAX_STRETCH)
    });
    let aligned = to * Matrix2::from_diagonal(&stretch) * from.transpose() * last.linear;
    let linears = [last.linear * scale, aligned, -aligned];
    linears.map(|linear| AffineMap { linear, translation: middle }).into()
}

/// The principal axes of points as columns of a rotation, the longer one first, and the standard deviations along them.
fn axes(points: &[[f64; 2]]) -> (Matrix2<f64>, Vector2<f64>) {
    let n = points.len().max(1) as f64;
    let mean = points.iter().map(|point| Vector2::from(*point)).sum::<Vector2<f64>>() / n;
    let mut covariance = Matrix2::zeros();
    for point in points {
        let offset = Vector2::from(*point) - mean;
        covariance += offset * offset.transpose() / n;
    }
    let (a, b, c) = (covariance[(0, 0)], covariance[(1, 1)], covariance[(0, 1)]);
    let (half_sum, half_gap) = (0.5 * (a + b), (0.5 * (a - b)).hypot(c));
    let (sin, cos) = (0.5 * (2.0 * c).atan2(a - b)).sin_cos();
    let spread = Vector2::new(half_sum + half_gap, (half_sum - half_gap).max(0.0)).map(f64::sqrt);
    (Matrix2::new(cos, -sin, sin, cos), spread)
}

/// The fixed point of colours when the light intensity changes; `None` in a space that has none.
pub(super) fn black(space: ColorSpace) -> Option<Vector3<f64>> {
    space.scales_with_light().then(|| Vector3::from(space.convert([0; 3])))
}

/// The colours of a reference in light of other strengths, from a third to three times as strong. Empty in a space in which stronger light
/// does not scale colours from black.
pub(super) fn in_other_light(space: ColorSpace, colors: &PrincipalColors) -> Vec<ColorDistributionState> {
    let Some(black) = black(space) else { return Vec::new() };
    let lit = |step: i32| {
        let gain = 3_f64.powf(f64::from(step) / f64::from(N_GAINS));
        let mut state = ColorDistributionState::at_rest(colors);
        let (mean, axis_sigmas) = (black + (state.mean() - black) * gain, state.axis_sigmas() * gain);
        state.value.fixed_rows_mut::<3>(0).copy_from(&mean);
        state.value.fixed_rows_mut::<3>(3).copy_from(&axis_sigmas);
        state
    };
    (-N_GAINS..=N_GAINS).map(lit).collect()
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::{BoundingBox, Outline, SnakeParams};
    use approx::assert_abs_diff_eq;

    #[test]
    fn a_snake_is_turned_and_stretched_onto_a_blob() {
        let flat = BoundingBox::from_center([50.0, 50.0], 60.0, 30.0).unwrap();
        let snake =
            AffineSnake::new(&Outline::ellipse(&flat, 100).unwrap(), &SnakeParams::default()).unwrap();
        // Upright and a little wider.
        let inside = |u: usize, v: usize| {
            ((u as f64 + 0.5 - 90.0) / 18.0).powi(2) + ((v as f64 + 0.5 - 60.0) / 30.0).powi(2) < 1.0
        };
        let blob = PixelMask::from_fn(140, 120, inside).unwrap();
        let overlap = |map: &AffineMap| {
            let outline = snake.outline_at(map).unwrap();
            PixelMask::from_polygon(140, 120, outline.points()).unwrap().iou(&blob).unwrap()
        };
        let [as_it_is, aligned, turned_back] = placements(&snake, &blob, (0, 0))[..] else {
            panic!("three ways")
        };
        // The middles of the rim are half a pixel within the blob, which is 1.7 and 2.8 % of its half axes.
        assert!(overlap(&aligned) > 0.93 && overlap(&turned_back) > 0.93 && overlap(&as_it_is) < 0.7);
        assert_abs_diff_eq!(aligned.linear, -turned_back.linear, epsilon = 1e-9);
        assert!(aligned.linear.determinant() > 0.0);
    }

    #[test]
    fn stronger_light_scales_colours_from_black() {
        let pixels = [[60, 30, 20], [80, 40, 30]];
        for space in ColorSpace::ALL {
            let of = |gain: u8| {
                let colors =
                    pixels.map(|pixel| Vector3::from(space.convert(pixel.map(|value: u8| gain * value))));
                PrincipalColors::of(&colors, &[1.0; 2], None).unwrap()
            };
            let lit = in_other_light(space, &of(1));
            // 3^(4/6) = 2.08, the step next to a gain of two.
            let Some(twice) = lit.get(10) else { continue };
            assert!((twice.mean() - of(2).mean).amax() < 0.03, "{space:?}");
            assert!((twice.axis_sigmas() - of(2).axis_sigmas).amax() < 0.01, "{space:?}");
        }
    }
}
