use std::f64::consts::SQRT_2;

use super::edge::{GradientField, N_POINTS, Rim};
use crate::{ColorBinImage, RowSpans, TrackingError};

/// Levels of the gradient, one for each octave of $`1 + |n · g|`$; the largest, of two bytes, is in the last.
pub(super) const N_LEVELS: usize = 9;

/// Parts of a head from top to bottom: hair, eyes and nose, mouth and chin. A head that turns keeps the height of its parts, and has other
/// surroundings above, beside and below it.
const N_PARTS: usize = 3;

/// Log-likelihood ratios of the head against its surroundings, for each colour in each part and for each level of the gradient across the rim.
///
/// A cue that does not distinguish the head from its surroundings has ratios near 0, so no weights are needed. One pixel of the smaller sample, or one
/// point of a rim, is added to every share, so unseen values have no effect.
#[derive(Clone, Debug)]
pub(super) struct CueRatios {
    /// Share of each colour in each part of the head.
    shares: Vec<Vec<f64>>,
    /// Ratio of each colour in each part.
    colors: Vec<Vec<f64>>,
    /// Share of the head's rim in each level.
    rim: [f64; N_LEVELS],
    levels: [f64; N_LEVELS],
}

impl CueRatios {
    /// Measured in a picture in which the head is known; the head's shares adapt at `rate` from those of `before`.
    pub(super) fn measured(
        (bins, field): (&ColorBinImage, &GradientField),
        (center, semi_axes): ([i64; 2], [f64; 2]),
        before: Option<(&Self, f64)>,
    ) -> Result<Self, TrackingError> {
        let ellipse = RowSpans::ellipse(semi_axes)?;
        let mut head = counts_of_parts(bins, &ellipse, center, &ellipse);
        let both = RowSpans::ellipse(semi_axes.map(|axis| SQRT_2 * axis))?;
        let mut around = counts_of_parts(bins, &both, center, &ellipse);
        for (around, inside) in around.iter_mut().flatten().zip(head.iter().flatten()) {
            *around -= inside;
        }
        let n_pixels: Vec<f64> = head.iter().map(|part| part.iter().sum()).collect();
        for (part, n) in head.iter_mut().zip(&n_pixels) {
            part.iter_mut().for_each(|count| *count /= n.max(1.0));
        }
        let outline = Rim::ellipse(semi_axes);
        let mut rim = levels(field, &outline, &[center]);
        let total = rim.iter().sum::<f64>();
        rim = rim.map(|count| count / total);
        if let Some((before, rate)) = before {
            (0..N_LEVELS).for_each(|k| rim[k] = before.rim[k] + rate * (rim[k] - before.rim[k]));
            for (share, before) in head.iter_mut().flatten().zip(before.shares.iter().flatten()) {
                *share = before + rate * (*share - before);
            }
        }
        let elsewhere = levels(field, &outline, &outline.some_points(center));
        Ok(Self::of_counts((head, &n_pixels), &around, rim, elsewhere))
    }

    /// From the shares of the colours of `n_pixels` pixels in each part of heads, the counts of those around, and the levels of rims, heads' and others.
    pub(super) fn of_counts(
        (shares, n_pixels): (Vec<Vec<f64>>, &[f64]),
        around: &[Vec<f64>],
        rim: [f64; N_LEVELS],
        elsewhere: [f64; N_LEVELS],
    ) -> Self {
        let log_ratio = |head: f64, other: f64, one: f64| libm::log((head + one) / (other + one));
        let part = |((shares, n), around): ((&Vec<f64>, &f64), &Vec<f64>)| -> Vec<f64> {
            let total = around.iter().sum::<f64>().max(1.0);
            let pixel = 1.0 / n.min(total).max(1.0);
            shares.iter().zip(around).map(|(share, count)| log_ratio(*share, count / total, pixel)).collect()
        };
        let colors = shares.iter().zip(n_pixels).zip(around).map(part).collect();
        let point = 1.0 / N_POINTS as f64;
        let [n_rim, n_elsewhere] = [&rim, &elsewhere].map(|counts| counts.iter().sum::<f64>());
        let levels = std::array::from_fn(|k| log_ratio(rim[k] / n_rim, elsewhere[k] / n_elsewhere, point));
        Self { shares, colors, rim, levels }
    }

    /// The sum of the ratios along a rim.
    pub(super) fn of_rim(&self, field: &GradientField, rim: &Rim, center: [i64; 2]) -> f64 {
        field.strengths(rim, center).map(|strength| self.levels[level(strength)]).sum()
    }
}

/// The colours under a shape in each part of the ellipse with the same centre; rows above and below the ellipse count to the first and last part.
fn counts_of_parts(
    bins: &ColorBinImage,
    shape: &RowSpans,
    center: [i64; 2],
    ellipse: &RowSpans,
) -> Vec<Vec<f64>> {
    let mut counts = vec![vec![0.0; bins.n_bins()]; N_PARTS];
    for (v, pixels) in (-center[1]..).zip(bins.rows()) {
        let Some(columns) = shape.columns(v) else { continue };
        let part = &mut counts[part_of(v, ellipse, N_PARTS)];
        let at = |u: i64| (u + center[0]).clamp(0, pixels.len() as i64) as usize;
        pixels[at(columns.start)..at(columns.end)].iter().for_each(|&bin| part[usize::from(bin)] += 1.0);
    }
    counts
}

/// The part of an ellipse in `n_parts` of equal height that a row belongs to.
fn part_of(row: i64, ellipse: &RowSpans, n_parts: usize) -> usize {
    let rows = ellipse.rows();
    ((row - rows.start) * n_parts as i64 / (rows.end - rows.start)).clamp(0, n_parts as i64 - 1) as usize
}

/// Sums of the ratios of the colours in each part along each row of a picture, up to each pixel.
pub(super) struct RatioSums {
    width: usize,
    sums: Vec<Vec<f64>>,
}

impl RatioSums {
    pub(super) fn new(ratios: &CueRatios, bins: &ColorBinImage) -> Self {
        let width = bins.width() + 1;
        let along_rows = |colors: &Vec<f64>| {
            let mut sums = Vec::with_capacity(width * bins.height());
            for row in bins.rows() {
                let mut sum = 0.0;
                sums.push(sum);
                for &bin in row {
                    sum += colors[usize::from(bin)];
                    sums.push(sum);
                }
            }
            sums
        };
        Self { width, sums: ratios.colors.iter().map(along_rows).collect() }
    }

    /// The sum of the ratios of the colours inside an ellipse; beyond the picture there is none.
    pub(super) fn inside(&self, ellipse: &RowSpans, center: [i64; 2]) -> f64 {
        let last = self.width as i64 - 1;
        let row = |v: i64| {
            let columns = ellipse.columns(v)?;
            let row = usize::try_from(v + center[1]).ok()?;
            let sums = &self.sums[part_of(v, ellipse, self.sums.len())];
            let up_to = |u: i64| sums.get(row * self.width + (u + center[0]).clamp(0, last) as usize);
            Some(up_to(columns.end)? - up_to(columns.start)?)
        };
        ellipse.rows().filter_map(row).sum()
    }
}

/// How many points of the rims about `centers` are in each level.
pub(super) fn levels(field: &GradientField, rim: &Rim, centers: &[[i64; 2]]) -> [f64; N_LEVELS] {
    let mut counts = [0.0; N_LEVELS];
    let found = centers.iter().flat_map(|&center| field.strengths(rim, center)).map(level);
    found.for_each(|level| counts[level] += 1.0);
    counts
}

fn level(strength: f32) -> usize {
    ((1.0 + strength) as u32).max(1).ilog2().min(N_LEVELS as u32 - 1) as usize
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::{ColorQuantizer, ColorSpace, RgbImage};
    use approx::abs_diff_eq;

    const SIZE: (usize, usize) = (60, 50);

    /// A red disc of radius 12 about (30, 25) on a ground of the given colours in turn.
    fn disc(ground: [[u8; 3]; 2]) -> RgbImage {
        let pixel = |i: usize| match ((i % SIZE.0) as f64 - 30.0).hypot((i / SIZE.0) as f64 - 25.0) {
            r if r <= 12.0 => [200, 60, 60],
            _ => ground[i % 7 % 2],
        };
        let bytes = (0..SIZE.0 * SIZE.1).flat_map(pixel).collect();
        RgbImage::from_raw(SIZE.0 as u32, SIZE.1 as u32, bytes).expect("3 bytes a pixel")
    }

    fn measured(picture: &RgbImage) -> (CueRatios, ColorBinImage, GradientField) {
        let quantizer = ColorQuantizer::new(ColorSpace::Opponent, [32, 32, 8]).unwrap();
        let (bins, field) = (ColorBinImage::new(&quantizer, picture).unwrap(), GradientField::new(picture));
        let ratios = CueRatios::measured((&bins, &field), ([30, 25], [12.0; 2]), None).unwrap();
        (ratios, bins, field)
    }

    #[test]
    fn sums_along_rows_are_the_sum_over_the_pixels() {
        let (ratios, bins, _) = measured(&disc([[40, 90, 60], [90, 40, 60]]));
        let sums = RatioSums::new(&ratios, &bins);
        let spans = RowSpans::ellipse([9.0, 14.0]).unwrap();
        // the second and third reach beyond the picture
        for center in [[30, 25], [3, 48], [58, -2]] {
            let mut plain = 0.0;
            for (i, &bin) in bins.bins().iter().enumerate() {
                let (u, v) = ((i % SIZE.0) as i64 - center[0], (i / SIZE.0) as i64 - center[1]);
                if spans.columns(v).is_some_and(|columns| columns.contains(&u)) {
                    plain += ratios.colors[part_of(v, &spans, N_PARTS)][usize::from(bin)];
                }
            }
            assert!(abs_diff_eq!(sums.inside(&spans, center), plain, epsilon = 1e-9), "{center:?}");
        }
    }

    #[test]
    fn a_cue_that_tells_nothing_has_no_weight() {
        let inside = |picture: &RgbImage| {
            let (ratios, bins, field) = measured(picture);
            let color =
                RatioSums::new(&ratios, &bins).inside(&RowSpans::ellipse([12.0; 2]).unwrap(), [30, 25]);
            (color, ratios.of_rim(&field, &Rim::ellipse([12.0; 2]), [30, 25]))
        };
        // a plain picture: neither cue; a disc on a plain ground: both
        let (color, gradient) = inside(&disc([[200, 60, 60]; 2]));
        assert!(color.abs() < 1e-9 && gradient.abs() < 1e-9, "{color} {gradient}");
        let (color, gradient) = inside(&disc([[60, 160, 60]; 2]));
        assert!(color > 441.0 && gradient > 64.0, "{color} {gradient}"); // more than a unit for each pixel and point
    }
}
