/// Colour distribution of pixels that show no map surface.
///
/// Densities of two poses are comparable only if both explain every pixel of the image; a pixel without a label counts as background. Uniform over
/// the $`256^3`$ colours unless learned. For a custom one, use [`from_pixels`](Self::from_pixels) with pixels known to be outside the map.
/// ```
/// use wayfix_color_model::BackgroundColorModel;
/// let wall = BackgroundColorModel::from_pixels([[200, 120, 130]; 4096]);
/// // 4096 pixels and 1 more in the cell that was seen, of 8192 in all; a cell has 16³ colours.
/// assert!((wall.log_density([207, 127, 143]) - (4097.0_f64 / 8192.0 / 4096.0).ln()).abs() < 1e-9);
/// assert!((BackgroundColorModel::default().log_density([0, 0, 0]) + 24.0 * 2.0_f64.ln()).abs() < 1e-9); // 256³ = 2²⁴
/// ```
#[derive(Clone, Debug, Default, PartialEq)]
pub enum BackgroundColorModel {
    /// All YUV values are equally likely.
    #[default]
    Uniform,
    /// Log densities of 4096 cells of 16 × 16 × 16 colours, by a histogram with one pixel added to each cell so that none is empty.
    Histogram(Vec<f64>),
}

const CELLS: usize = 1 << 12;
const COLOURS: f64 = 16_777_216.0;

impl BackgroundColorModel {
    /// Learns from pixels outside the map; without pixels the density is uniform.
    /// ```
    /// use wayfix_color_model::BackgroundColorModel;
    /// let wall = BackgroundColorModel::from_pixels([[200, 120, 130]; 5000].iter().copied());
    /// assert!(wall.log_density([201, 121, 131]) > BackgroundColorModel::Uniform.log_density([201, 121, 131]) + 5.0);
    /// ```
    pub fn from_pixels(pixels: impl IntoIterator<Item = [u8; 3]>) -> Self {
        let mut counts = vec![1.0; CELLS];
        for pixel in pixels {
            counts[cell(pixel)] += 1.0;
        }
        let total: f64 = counts.iter().sum();
        let log_density = |count: f64| (count / total * CELLS as f64 / COLOURS).ln();
        Self::Histogram(counts.into_iter().map(log_density).collect())
    }

    /// $`\ln p_{bg}(c)`$ of a pixel, nats.
    pub fn log_density(&self, pixel: [u8; 3]) -> f64 {
        match self {
            Self::Uniform => -COLOURS.ln(),
            Self::Histogram(cells) => cells.get(cell(pixel)).copied().unwrap_or(-COLOURS.ln()),
        }
    }
}

fn cell([y, u, v]: [u8; 3]) -> usize {
    (usize::from(y >> 4) << 8) | (usize::from(u >> 4) << 4) | usize::from(v >> 4)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn densities_sum_to_one_over_all_colours() {
        let learned = BackgroundColorModel::from_pixels([[10, 20, 30], [10, 20, 31], [250, 0, 255]]);
        for background in [learned, BackgroundColorModel::Uniform] {
            let centre = |k: usize| [(k >> 8) as u8 * 16, ((k >> 4) & 15) as u8 * 16, (k & 15) as u8 * 16];
            let sum: f64 =
                (0..CELLS).map(|k| background.log_density(centre(k)).exp() * COLOURS / CELLS as f64).sum();
            assert!((sum - 1.0).abs() < 1e-9);
        }
    }
}
