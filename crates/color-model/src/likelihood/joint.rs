use nalgebra::{DMatrix, DVector, Matrix3, Vector3};
use wayfix_estimation_traits::LogWeight;

use super::{PixelLikelihoodParams, params::Region};
use crate::PixelSums;

/// The likelihood of all pixels jointly, under one common light.
///
/// Eq. 9 treats the light of every pixel as independent, so with an uncertain light even the correct pose pays for it at every pixel; here it pays
/// once:
/// ```math
/// \ln \int \prod_m \prod_{c ∈ m} N(c; θ_m + e_m, S_m)^β\, N(e; 0, R)\, N(θ; μ, Σ)\, dθ\, de
/// ```
///
/// $`β`$ is the tempering, $`R`$ the variance of an image's means, and $`S_m = ν + σ^2 \operatorname{diag}(s_m s_m^\top) + \hat S_m`$ the covariance of the region's pixels: noise, uneven
/// light, and the scatter $`\hat S_m`$ about the region's mean $`\bar c_m`$, which stands for what the map does not know of the surface. In closed form this is the
/// density of each region's pixels about their mean, $`β \sum_c \ln N(c; \bar c_m, S_m)`$, plus that of all means,
/// $`\ln N(\bar c; μ, Σ + R + S/βn) - \ln N(0; 0, S/βn)`$. Of $`S/βn`$ the diagonal is used.
pub(crate) struct JointLikelihood {
    /// Of the regions that a pose shows.
    regions: Vec<Mean>,
    within: LogWeight,
    /// Lower triangle of the means' covariance, row by row, and their residuals.
    covariance: Vec<f64>,
    residuals: Vec<f64>,
}

/// Mean colour of a region.
struct Mean {
    /// First row of its colour in the state of the light.
    row: usize,
    value: Vector3<f64>,
    /// Variance of the mean of the pixels about the region's mean in this image, $`\operatorname{diag} S/βn`$.
    variance: Vector3<f64>,
}

impl JointLikelihood {
    pub(crate) fn new() -> Self {
        Self { regions: Vec::new(), within: 0.0, covariance: Vec::new(), residuals: Vec::new() }
    }

    /// Takes what a pose shows; the terms of all lights are computed once. `noise` is $`ν`$.
    pub(crate) fn set_sums(
        &mut self,
        sums: &[PixelSums],
        params: &PixelLikelihoodParams,
        noise: &Vector3<f64>,
        n_pixels: usize,
    ) {
        self.regions.clear();
        let tempering = params.tempering(n_pixels);
        let region = |(color, sums): (usize, &PixelSums)| {
            let Some(mean) = sums.mean() else { return Region::new(sums, 0.0) };
            let (n, scatter) = (sums.count() as f64, sums.scatter_about(&mean));
            let covariance = Matrix3::from_diagonal(&(noise + params.shade(&mean).diagonal())) + scatter / n;
            let Some(factor) = covariance.cholesky() else { return Region::new(sums, f64::NEG_INFINITY) };
            let variance = covariance.diagonal() / (tempering * n);
            self.regions.push(Mean { row: 3 * color, value: mean, variance });
            let log_root = factor.l_dirty().diagonal().product().ln();
            let log_density =
                n * (-1.5 * std::f64::consts::TAU.ln() - log_root) - 0.5 * factor.inverse().dot(&scatter);
            Region::new(sums, log_density)
        };
        let regions = sums.iter().enumerate().map(region);
        self.within = params.log_likelihood(n_pixels, regions);
    }

    /// The log-likelihood ratio to the background under a light of this mean and covariance; `mean_color_variance` is $`R`$.
    pub(crate) fn log_likelihood(
        &mut self,
        (light, covariance): (&DVector<f64>, &DMatrix<f64>),
        mean_color_variance: &Vector3<f64>,
    ) -> LogWeight {
        let Self { regions, covariance: triangle, residuals, .. } = self;
        triangle.clear();
        residuals.clear();
        let mut log = self.within;
        for (at, region) in regions.iter().enumerate() {
            log += 0.5 * region.variance.product().ln();
            for channel in 0..3 {
                let row = region.row + channel;
                residuals.push(region.value[channel] - light[row]);
                for other in &regions[..at] {
                    triangle.extend((0..3).map(|column| covariance[(row, other.row + column)]));
                }
                triangle.extend((0..=channel).map(|column| covariance[(row, region.row + column)]));
                if let Some(diagonal) = triangle.last_mut() {
                    *diagonal += region.variance[channel] + mean_color_variance[channel];
                }
            }
        }
        log + log_normal(triangle, residuals)
    }
}

/// Number of standard deviations whose product a double can hold.
const FACTORS: usize = 15;

/// $`-\tfrac{1}{2} (\ln |S| + r^T S^{-1} r)`$ of a covariance given as the rows of its lower triangle, by Cholesky in place.
fn log_normal(covariance: &mut [f64], residuals: &mut [f64]) -> f64 {
    let (mut log, mut root) = (0.0, 1.0);
    for i in 0..residuals.len() {
        let (above, row) = covariance.split_at_mut(i * (i + 1) / 2);
        for j in 0..i {
            let other = &above[j * (j + 1) / 2..][..=j];
            let dot: f64 = row[..j].iter().zip(other).map(|(a, b)| a * b).sum();
            row[j] = (row[j] - dot) / other[j];
        }
        let square: f64 = row[..i].iter().map(|a| a * a).sum();
        let dot: f64 = row[..i].iter().zip(&residuals[..i]).map(|(a, r)| a * r).sum();
        let pivot = (row[i] - square).sqrt();
        row[i] = pivot;
        residuals[i] = (residuals[i] - dot) / pivot;
        log -= 0.5 * residuals[i] * residuals[i];
        // One logarithm for several: all of them together could be too large.
        root *= pivot;
        if i % FACTORS == FACTORS - 1 {
            log -= root.ln();
            root = 1.0;
        }
    }
    log - root.ln()
}

#[cfg(test)]
mod tests {
    use super::*;

    /// $`\int N(x; μ, σ^2)\, e^{-a (x - m)^2}\, dx`$ by the trapezoidal rule.
    fn integral(mean: f64, variance: f64, a: f64, m: f64) -> f64 {
        let (n, step) = (20_000, 0.01);
        let at = |k: i32| {
            let x = mean + f64::from(k - n / 2) * step;
            (-0.5 * (x - mean).powi(2) / variance - a * (x - m).powi(2)).exp()
        };
        (0..=n).map(at).sum::<f64>() * step / (std::f64::consts::TAU * variance).sqrt()
    }

    #[test]
    fn closed_form_is_the_integral_over_the_light() {
        let pixels = [[90, 118, 130], [96, 122, 130], [90, 122, 126], [96, 118, 126]];
        let mut sums = PixelSums::default();
        pixels.into_iter().for_each(|pixel| sums.add_pixel(pixel));
        let params = PixelLikelihoodParams {
            n_effective_pixels: 10.0,
            brightness_variation: 0.0,
            outlier_share: 1e-9,
            ..Default::default()
        };
        let (noise, mean_color_variance, n_pixels) =
            (Vector3::new(12.0, 6.0, 6.0), Vector3::new(8.0, 4.0, 4.0), 20);
        let (light, variances) = (Vector3::new(100.0, 119.0, 129.0), Vector3::new(25.0, 9.0, 9.0));

        let mut joint = JointLikelihood::new();
        joint.set_sums(&[sums], &params, &noise, n_pixels);
        let belief = (
            DVector::from_column_slice(light.as_slice()),
            DMatrix::from_diagonal(&DVector::from_column_slice(variances.as_slice())),
        );
        let closed = joint.log_likelihood((&belief.0, &belief.1), &mean_color_variance);

        let beta = 0.5; // 10 independent of 20 pixels
        let mut expected = 0.0;
        for channel in 0..3 {
            let values = pixels.map(|pixel| f64::from(pixel[channel]));
            let mean = values.iter().sum::<f64>() / 4.0;
            let scatter: f64 = values.iter().map(|value| (value - mean).powi(2)).sum();
            let variance = noise[channel] + scatter / 4.0; // S
            let peak = -0.5 * (std::f64::consts::TAU * variance).ln();
            let prior = variances[channel] + mean_color_variance[channel]; // of θ + e
            expected += beta * (4.0 * peak - 0.5 * scatter / variance);
            expected += integral(light[channel], prior, 0.5 * beta * 4.0 / variance, mean).ln();
        }
        assert!((closed - expected).abs() < 1e-6, "{closed} {expected}");
    }
}
