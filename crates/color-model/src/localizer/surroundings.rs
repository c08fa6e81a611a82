use nalgebra::Vector3;

use crate::YuvImage;

/// Side of a cell of the histogram, as a share of the standard deviation that a colour of the map is granted.
const CELL: f64 = 1.0;

/// The background that labels have to beat when none was learned: how often each colour occurs in the images themselves, seen with the
/// scatter that a colour of the map is granted.
///
/// Beside a uniform background any label would pay that puts one loose colour over everything. Against what the images show on
/// average, a label pays when its pixels are told apart from the others by it: $`\ln N(c; μ_m, ν) / q(c)`$ sums to the mutual information of
/// labels and colours for the right pose, and to a negative divergence for a label that fits everything.
pub(crate) struct Surroundings {
    histogram: Histogram,
    /// Of the counts to densities, and what a colour that never occurs has.
    per_count: f64,
    uniform: f64,
}

impl Surroundings {
    /// What `images` show; `noise` is the variance of a map colour's pixels. A uniform share keeps the density from vanishing.
    pub(crate) fn of<'a>(
        images: impl Iterator<Item = &'a YuvImage>,
        noise: &Vector3<f64>,
        uniform_share: f64,
    ) -> Self {
        let mut histogram = Histogram::new(noise.map(|variance| CELL * variance.sqrt()));
        let mut n = 0;
        for image in images {
            image.pixels().iter().for_each(|pixel| histogram.add(*pixel));
            n += image.pixels().len();
        }
        (0..3).for_each(|channel| histogram.blur(channel));
        let volume = histogram.widths.product();
        Self {
            histogram,
            per_count: (1.0 - uniform_share) / (n.max(1) as f64 * volume),
            uniform: uniform_share / f64::from(1_u32 << 24),
        }
    }

    /// $`-\ln p_{bg}(c)`$.
    pub(crate) fn nats(&self, pixel: [u8; 3]) -> f64 {
        -(self.uniform + self.per_count * f64::from(self.histogram.at(pixel))).ln()
    }
}

/// Counts of pixels in cells of YUV.
struct Histogram {
    widths: Vector3<f64>,
    sizes: [usize; 3],
    counts: Vec<f32>,
}

impl Histogram {
    fn new(widths: Vector3<f64>) -> Self {
        let widths = widths.map(|width| width.clamp(1.5, 64.0));
        let sizes: [usize; 3] = widths.map(|width| (255.0 / width) as usize + 1).into();
        Self { widths, sizes, counts: vec![0.0; sizes.iter().product()] }
    }

    fn index(&self, pixel: [u8; 3]) -> usize {
        let [y, u, v] = [0, 1, 2].map(|channel| (f64::from(pixel[channel]) / self.widths[channel]) as usize);
        (y * self.sizes[1] + u) * self.sizes[2] + v
    }

    fn add(&mut self, pixel: [u8; 3]) {
        let at = self.index(pixel);
        self.counts[at] += 1.0;
    }

    fn at(&self, pixel: [u8; 3]) -> f32 {
        self.counts[self.index(pixel)]
    }

    /// A quarter of each count goes to either neighbour, twice: with the cell's own width a standard deviation of about one cell.
    fn blur(&mut self, channel: usize) {
        let stride: usize = self.sizes[channel + 1..].iter().product();
        let size = self.sizes[channel];
        for _ in 0..2 {
            for block in self.counts.chunks_mut(stride * size) {
                let mut last = block[..stride].to_vec();
                for at in 0..size {
                    for lane in 0..stride {
                        let here = block[at * stride + lane];
                        let next = if at + 1 < size { block[(at + 1) * stride + lane] } else { here };
                        block[at * stride + lane] = 0.25 * (last[lane] + next) + 0.5 * here;
                        last[lane] = here;
                    }
                }
            }
        }
    }
}
