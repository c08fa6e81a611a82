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
    sizes: [usize; 3],
    counts: Vec<f32>,
    log_total: f64,
}

impl ImageHistogram {
    /// Counts the pixels of `images`; `noise` is the variance of a pixel by noise.
    pub(crate) fn new<'a>(
        images: impl Iterator<Item = &'a YuvImage> + Clone,
        noise: &Vector3<f64>,
        params: &PixelLikelihoodParams,
    ) -> Self {
        let (mut sum, mut n) = (Vector3::zeros(), 0.0);
        for pixel in images.clone().flat_map(YuvImage::pixels) {
            sum += Vector3::from(pixel.map(f64::from));
            n += 1.0;
        }
        let variance = noise + params.shade(&(sum / f64::max(n, 1.0))).diagonal();
        // A cell itself has 1/12 of its squared width, and smoothing adds one squared width.
        let variance = variance / (1.0 + 1.0 / 12.0);
        // A cell is at least one value wide and at most the whole range.
        let widths = variance.map(|variance| variance.sqrt().clamp(1.0, 255.0));
        let sizes: [usize; 3] = widths.map(|width| (255.0 / width) as usize + 1).into();
        let counts = vec![0.0; sizes.iter().product()];
        let mut histogram = Self { widths, sizes, counts, log_total: 0.0 };
        for pixel in images.flat_map(YuvImage::pixels) {
            let at = histogram.index(*pixel);
            histogram.counts[at] += 1.0;
        }
        for channel in [0, 1, 2, 0, 1, 2] {
            histogram.smooth(channel);
        }
        let pseudo_count = 1.0 / histogram.counts.len() as f32;
        histogram.counts.iter_mut().for_each(|count| *count += pseudo_count);
        let total: f64 = histogram.counts.iter().copied().map(f64::from).sum();
        histogram.log_total = (total * widths.product()).ln();
        histogram
    }

    /// $`-\ln p_{bg}(c)`$, in nats.
    pub(crate) fn nats(&self, pixel: [u8; 3]) -> f64 {
        self.log_total - f64::from(self.counts[self.index(pixel)]).ln()
    }

    fn index(&self, pixel: [u8; 3]) -> usize {
        let [y, u, v] = [0, 1, 2].map(|channel| (f64::from(pixel[channel]) / self.widths[channel]) as usize);
        (y * self.sizes[1] + u) * self.sizes[2] + v
    }

    /// Averages each cell with the next one, forwards and backwards: the binomial kernel, whose variance is half of a squared cell.
    fn smooth(&mut self, channel: usize) {
        let stride: usize = self.sizes[channel + 1..].iter().product();
        let size = self.sizes[channel];
        for block in self.counts.chunks_mut(stride * size) {
            for at in 1..size {
                for lane in 0..stride {
                    let mean = (block[(at - 1) * stride + lane] + block[at * stride + lane]) / 2.0;
                    block[(at - 1) * stride + lane] = mean;
                }
            }
            for at in (1..size).rev() {
                for lane in 0..stride {
                    let mean = (block[(at - 1) * stride + lane] + block[at * stride + lane]) / 2.0;
                    block[at * stride + lane] = mean;
                }
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
        let [n_y, n_u, n_v] = histogram.sizes;
        let cells = (0..n_y).flat_map(|y| (0..n_u).flat_map(move |u| (0..n_v).map(move |v| [y, u, v])));
        let sum: f64 = cells.map(|at| (-histogram.nats(cell(at))).exp() * volume).sum();
        assert!((sum - 1.0).abs() < 1e-3, "{sum}"); // single-precision counts
    }
}
