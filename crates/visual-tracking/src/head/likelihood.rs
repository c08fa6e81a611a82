use super::bimodal::BimodalHistogram;
use super::edge::{GradientField, N_POINTS, Rim};
use super::surroundings::ring;
use crate::{ColorBinImage, RowSpans, TrackingError};

/// Levels of the gradient, one for each octave of $`1 + |n · g|`$; the largest, of two bytes, is in the last.
pub(super) const N_LEVELS: usize = 9;

/// Log-likelihood ratios of the head against its surroundings, for each colour and for each level of the gradient across the rim.
///
/// A cue that does not tell the head from its surroundings has ratios near 0, so no weights are needed. One pixel, or one point of a rim, is
/// added to every share, so what was never seen says nothing.
#[derive(Clone, Debug)]
pub(super) struct CueRatios {
    colors: Vec<f64>,
    /// Share of the head's rim in each level.
    rim: [f64; N_LEVELS],
    levels: [f64; N_LEVELS],
}

impl CueRatios {
    /// Measured in a picture in which the head is known; the rim's shares adapt at `rate` from those of `before`.
    pub(super) fn measured(
        model: &BimodalHistogram,
        (bins, field): (&ColorBinImage, &GradientField),
        (center, semi_axes): ([i64; 2], [f64; 2]),
        before: Option<(&Self, f64)>,
    ) -> Result<Self, TrackingError> {
        let (inside, around) = ring(bins, center, semi_axes)?;
        let outline = Rim::ellipse(semi_axes);
        let mut rim = levels(field, &outline, &[center]);
        let total = rim.iter().sum::<f64>();
        rim = rim.map(|count| count / total);
        if let Some((before, rate)) = before {
            (0..N_LEVELS).for_each(|k| rim[k] = before.rim[k] + rate * (rim[k] - before.rim[k]));
        }
        let elsewhere = levels(field, &outline, &outline.some_points(center));
        Ok(Self::of_counts((model.shares(), inside.total()), &around, rim, elsewhere))
    }

    /// From the shares of the colours of `n_pixels` pixels of heads, the counts of those around, and the levels of rims, heads' and others.
    pub(super) fn of_counts(
        (shares, n_pixels): (&[f64], f64),
        around: &[f64],
        rim: [f64; N_LEVELS],
        elsewhere: [f64; N_LEVELS],
    ) -> Self {
        let log_ratio = |head: f64, other: f64, one: f64| libm::log((head + one) / (other + one));
        let (pixel, point) = (1.0 / n_pixels.max(1.0), 1.0 / N_POINTS as f64);
        let total = around.iter().sum::<f64>().max(1.0);
        let color = |(share, count): (&f64, &f64)| log_ratio(*share, count / total, pixel);
        let colors = shares.iter().zip(around).map(color).collect();
        let [n_rim, n_elsewhere] = [&rim, &elsewhere].map(|counts| counts.iter().sum::<f64>());
        let levels = std::array::from_fn(|k| log_ratio(rim[k] / n_rim, elsewhere[k] / n_elsewhere, point));
        Self { colors, rim, levels }
    }

    /// The sum of the ratios along a rim.
    pub(super) fn of_rim(&self, field: &GradientField, rim: &Rim, center: [i64; 2]) -> f64 {
        field.strengths(rim, center).map(|strength| self.levels[level(strength)]).sum()
    }
}

/// Sums of the ratios of the colours along each row of a picture, up to each pixel.
pub(super) struct RatioSums {
    width: usize,
    sums: Vec<f64>,
}

impl RatioSums {
    pub(super) fn new(ratios: &CueRatios, bins: &ColorBinImage) -> Self {
        let width = bins.width() + 1;
        let mut sums = Vec::with_capacity(width * bins.height());
        for row in bins.rows() {
            let mut sum = 0.0;
            sums.push(sum);
            for &bin in row {
                sum += ratios.colors[usize::from(bin)];
                sums.push(sum);
            }
        }
        Self { width, sums }
    }

    /// The sum of the ratios of the colours inside a shape; beyond the picture there is none.
    pub(super) fn inside(&self, spans: &RowSpans, center: [i64; 2]) -> f64 {
        let last = self.width as i64 - 1;
        let row = |v: i64| {
            let columns = spans.columns(v)?;
            let row = usize::try_from(v + center[1]).ok()?;
            let up_to = |u: i64| self.sums.get(row * self.width + (u + center[0]).clamp(0, last) as usize);
            Some(up_to(columns.end)? - up_to(columns.start)?)
        };
        spans.rows().filter_map(row).sum()
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
    use crate::{ColorQuantizer, ColorSpace, RgbImage, SlidingHistogram};
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
        let spans = RowSpans::ellipse([12.0; 2]).unwrap();
        let head = SlidingHistogram::new(&bins, spans, [30, 25]).into_histogram();
        let model = BimodalHistogram::new(&quantizer, head.counts(), false).unwrap();
        let ratios = CueRatios::measured(&model, (&bins, &field), ([30, 25], [12.0; 2]), None).unwrap();
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
                    plain += ratios.colors[usize::from(bin)];
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
