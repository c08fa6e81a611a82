use nalgebra::{Matrix3, Vector3};

/// Lanes of a sum: y u v, yy uu vv yu yv uv, count, background, outlier count.
pub(crate) const LANES: usize = 12;
pub(crate) const COUNT: usize = 9;
const BACKGROUND: usize = 10;
pub(crate) const OUTLIERS: usize = 11;

/// Nats per unit of the background lane.
const BACKGROUND_UNIT: f64 = 1.0 / 65536.0;

/// Sufficient statistics of a set of pixels for a Gaussian likelihood, exact: number, $`\sum c`$ and $`\sum c c^T`$.
/// ```
/// use wayfix_color_model::PixelSums;
/// let mut sums = PixelSums::default();
/// sums.add_pixel([10, 128, 128]);
/// sums.add_pixel([14, 128, 128]);
/// assert_eq!(sums.mean().unwrap().x, 12.0);
/// assert_eq!(sums.scatter_about(&sums.mean().unwrap())[(0, 0)], 8.0); // 2² + 2²
/// ```
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct PixelSums {
    pub(crate) lanes: [u64; LANES],
}

impl PixelSums {
    /// Adds one pixel, Y U V.
    pub fn add_pixel(&mut self, pixel: [u8; 3]) {
        for (sum, lane) in self.lanes.iter_mut().zip(lanes_of(pixel, 0)) {
            *sum += u64::from(lane);
        }
    }

    /// Adds another sum.
    pub fn add(&mut self, other: &Self) {
        for (sum, lane) in self.lanes.iter_mut().zip(other.lanes) {
            *sum += lane;
        }
    }

    /// Number of pixels.
    pub fn count(&self) -> u64 {
        self.lanes[COUNT]
    }
    /// $`\sum c`$, Y U V.
    pub fn sum(&self) -> Vector3<f64> {
        Vector3::new(self.lane(0), self.lane(1), self.lane(2))
    }
    /// $`\sum c c^T`$.
    pub fn products(&self) -> Matrix3<f64> {
        let [yy, uu, vv, yu, yv, uv] = [3, 4, 5, 6, 7, 8].map(|lane| self.lane(lane));
        Matrix3::new(yy, yu, yv, yu, uu, uv, yv, uv, vv)
    }
    /// Variance of the pixels about their mean; 0 of no pixels.
    pub(crate) fn variance(&self) -> Vector3<f64> {
        let Some(mean) = self.mean() else { return Vector3::zeros() };
        Vector3::new(self.lane(3), self.lane(4), self.lane(5)) / self.count() as f64
            - mean.component_mul(&mean)
    }
    /// The mean colour; `None` of no pixels.
    pub fn mean(&self) -> Option<Vector3<f64>> {
        (self.count() > 0).then(|| self.sum() / self.count() as f64)
    }
    /// $`\sum (c - μ)(c - μ)^T`$ about any $`μ`$.
    pub fn scatter_about(&self, mean: &Vector3<f64>) -> Matrix3<f64> {
        let cross = self.sum() * mean.transpose();
        self.products() - cross - cross.transpose() + mean * mean.transpose() * self.count() as f64
    }
    /// $`-\sum \ln p_{bg}(c)`$ in nats: the background's cost of these pixels. 0 for a frame without background.
    pub fn background_nats(&self) -> f64 {
        self.lane(BACKGROUND) * BACKGROUND_UNIT
    }
    /// Number of outliers among the pixels; the other sums exclude them.
    pub fn n_outliers(&self) -> u64 {
        self.lanes[OUTLIERS]
    }

    fn lane(&self, lane: usize) -> f64 {
        self.lanes[lane] as i64 as f64 // signed, since that is one instruction; sums stay far below 2⁶³
    }
}

/// Contribution of one pixel to each lane.
pub(crate) fn lanes_of([y, u, v]: [u8; 3], background: u32) -> [u32; LANES] {
    let [y, u, v] = [u32::from(y), u32::from(u), u32::from(v)];
    [y, u, v, y * y, u * u, v * v, y * u, y * v, u * v, 1, background, 0]
}

/// Nats as the background lane counts them: rounded to 2⁻¹⁶, at least 0 (a density over whole numbers is at most 1), at most 16.8.
pub(crate) fn background_units(nats: f64) -> u32 {
    (nats / BACKGROUND_UNIT).round().clamp(0.0, 1_101_004.0) as u32
}

/// Nats after [`background_units`].
pub(crate) fn rounded(nats: f64) -> f64 {
    f64::from(background_units(nats)) * BACKGROUND_UNIT
}
