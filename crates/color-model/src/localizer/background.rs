use nalgebra::Vector3;

use crate::{PixelLikelihoodParams, YuvImage};

/// Distribution of the colours of the images themselves: the background that labels have to beat if none was learned.
///
/// A uniform background would favour a label with a wide density everywhere. Against the average of the image, $`\ln N(c; μ_m, ν) / q(c)`$ sums to the mutual
/// information of labels and colours at the right pose, and to a negative divergence for a label that fits every pixel.
///
/// The density has the resolution of a region of the map: counts are smoothed by the standard deviation of a pixel about the mean of its colour, noise and uneven light
/// together. Otherwise it would explain the pixels of a homogeneous region better than the region's own colour. One pseudo-count is shared by all cells. [Perks 1947]
pub(crate) struct ImageHistogram {
    widths: Vector3<f64>,
    /// First cell of the box that the colours of the images fill, and its size.
    first: [usize; 3],
    sizes: [usize; 3],
    counts: Vec<f32>,
    pseudo_count: f64,
    log_total: f64,
}

/// Cells about the box that stay empty until the last pass of smoothing, so that no count is lost.
const REACH: usize = 3;

impl ImageHistogram {
    /// Counts the pixels of `images`; `noise` is the variance of a pixel by noise.
    pub(crate) fn new<'a>(
        images: impl Iterator<Item = &'a YuvImage> + Clone,
        noise: &Vector3<f64>,
        params: &PixelLikelihoodParams,
    ) -> Self {
        let pixels = || images.clone().flat_map(YuvImage::pixels);
        let (mut sum, mut n, mut range) = (Vector3::zeros(), 0_usize, [[u8::MAX, 0]; 3]);
        for pixel in pixels() {
            sum += Vector3::from(pixel.map(f64::from));
            n += 1;
            for ([least, most], value) in range.iter_mut().zip(pixel) {
                (*least, *most) = ((*least).min(*value), (*most).max(*value));
            }
        }
        let variance = noise + params.shade(&(sum / n.max(1) as f64)).diagonal();
        // A cell itself has 1/12 of its squared width, and smoothing adds one squared width.
        let variance = variance / (1.0 + 1.0 / 12.0);
        // A cell is at least one value wide and at most the whole range.
        let widths = variance.map(|variance| variance.sqrt().clamp(1.0, 255.0));
        let cell = |channel: usize, value: u8| (f64::from(value) / widths[channel]) as usize;
        let n_cells: usize = (0..3).map(|channel| cell(channel, u8::MAX) + 1).product();
        let first = [0, 1, 2].map(|at| cell(at, range[at][0].min(range[at][1])).saturating_sub(REACH));
        let sizes = [0, 1, 2]
            .map(|at| (cell(at, range[at][1]) + REACH).min(cell(at, u8::MAX)).saturating_sub(first[at]) + 1);
        let pseudo_count = 1.0 / n_cells as f64;
        let counts = vec![0.0; sizes.iter().product()];
        let mut histogram = Self { widths, first, sizes, counts, pseudo_count, log_total: 0.0 };
        for pixel in pixels() {
            if let Some(at) = histogram.index(*pixel) {
                histogram.counts[at] += 1.0;
            }
        }
        for channel in [0, 1, 2, 0, 1, 2] {
            histogram.smooth(channel);
        }
        let total = 1.0 + histogram.counts.iter().copied().map(f64::from).sum::<f64>();
        histogram.log_total = (total * widths.product()).ln();
        histogram
    }

    /// Widths of its cells.
    pub(crate) fn widths(&self) -> &Vector3<f64> {
        &self.widths
    }

    /// $`-\ln p_{bg}(c)`$, in nats.
    pub(crate) fn nats(&self, pixel: [u8; 3]) -> f64 {
        let count = self.index(pixel).map_or(0.0, |at| f64::from(self.counts[at]));
        self.log_total - (count + self.pseudo_count).ln()
    }

    fn index(&self, pixel: [u8; 3]) -> Option<usize> {
        (0..3).try_fold(0, |index, at| {
            let cell = ((f64::from(pixel[at]) / self.widths[at]) as usize).checked_sub(self.first[at])?;
            (cell < self.sizes[at]).then_some(index * self.sizes[at] + cell)
        })
    }

    /// Averages each cell with the next one, forwards and backwards: the binomial kernel, whose variance is half of a squared cell.
    fn smooth(&mut self, channel: usize) {
        let stride: usize = self.sizes[channel + 1..].iter().product();
        for block in self.counts.chunks_mut(stride * self.sizes[channel]) {
            for at in stride..block.len() {
                block[at - stride] = f32::midpoint(block[at - stride], block[at]);
            }
            for at in (stride..block.len()).rev() {
                block[at] = f32::midpoint(block[at - stride], block[at]);
            }
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn density_is_normalized_and_highest_where_pixels_are() {
        let pixels = vec![[100, 120, 140]; 900].into_iter().chain(vec![[30, 128, 128]; 100]).collect();
        let image = YuvImage::new(50, 20, pixels).unwrap();
        let params = PixelLikelihoodParams { brightness_variation: 0.0, ..PixelLikelihoodParams::default() };
        let histogram =
            ImageHistogram::new(std::iter::once(&image), &Vector3::new(144.0, 36.0, 36.0), &params);
        assert!(histogram.nats([100, 120, 140]) < histogram.nats([30, 128, 128]));
        assert!(histogram.nats([30, 128, 128]) < histogram.nats([250, 10, 10]));
        let volume = histogram.widths.product();
        let cell = |at: [usize; 3]| {
            [0, 1, 2].map(|channel| ((at[channel] as f64 + 0.5) * histogram.widths[channel]) as u8)
        };
        let [n_y, n_u, n_v] = [0, 1, 2].map(|channel| (255.0 / histogram.widths[channel]) as usize + 1);
        let cells = (0..n_y).flat_map(|y| (0..n_u).flat_map(move |u| (0..n_v).map(move |v| [y, u, v])));
        let sum: f64 = cells.map(|at| (-histogram.nats(cell(at))).exp() * volume).sum();
        assert!((sum - 1.0).abs() < 1e-3, "{sum}"); // single-precision counts
    }
}
