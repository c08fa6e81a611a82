use nalgebra::{Matrix3, Vector3};
use wayfix_estimation_traits::LogWeight;

use super::{PixelLikelihoodParams, params::Region};
use crate::{LightingFilter, PixelSums};

/// The likelihood of all pixels jointly, under one common light.
///
/// $`\ln \int \prod_m \prod_{c ∈ m} N(c; θ_m + e_m, ν)^β\, N(e; 0, R)\, N(θ; μ, Σ)\, dθ\, de`$, with $`β`$ the tempering and $`R`$ the variance of
/// an image's means. Eq. 9 treats the light of every pixel as independent, so with an uncertain light even the correct pose pays for it at every
/// pixel; here it pays once. In closed form, from the same sums: [`log_within`], the scatter of each colour about its own mean, and
/// [`log_innovation`](Self::log_innovation) of all means.
pub(crate) struct JointLikelihood {
    /// Lower triangle of the means' covariance, row by row, and their residuals.
    covariance: Vec<f64>,
    residuals: Vec<f64>,
    rows: Vec<usize>,
    noises: Vec<f64>,
}

impl JointLikelihood {
    pub(crate) fn new() -> Self {
        Self { covariance: Vec::new(), residuals: Vec::new(), rows: Vec::new(), noises: Vec::new() }
    }

    /// Log-likelihood of the colour means under a light: $`\ln N(\bar v; μ, Σ + R + ν/βn) - \ln N(0; 0, ν/βn)`$ over the seen colours.
    pub(crate) fn log_innovation(
        &mut self,
        sums: &[PixelSums],
        filter: &LightingFilter,
        params: &PixelLikelihoodParams,
        pixel: &Vector3<f64>,
        n_pixels: usize,
    ) -> LogWeight {
        let tempering = params.independent_pixels / n_pixels.max(1) as f64;
        let of_mean = filter.params().mean_color_variance;
        self.rows.clear();
        self.residuals.clear();
        self.noises.clear();
        let mut log = 0.0;
        for (color, sums) in sums.iter().enumerate() {
            let Some(mean) = sums.mean() else { continue };
            let noise = pixel / (tempering * sums.count() as f64);
            log += 0.5 * noise.product().ln();
            for channel in 0..3 {
                let row = 3 * color + channel;
                self.rows.push(row);
                self.residuals.push(mean[channel] - filter.mean()[row]);
                self.noises.push(noise[channel] + of_mean[channel]);
            }
        }
        let covariance = filter.covariance();
        self.covariance.clear();
        for (i, &row) in self.rows.iter().enumerate() {
            self.covariance.extend(self.rows[..=i].iter().map(|&column| covariance[(row, column)]));
            let diagonal = self.covariance.len() - 1;
            self.covariance[diagonal] += self.noises[i];
        }
        log + log_normal(&mut self.covariance, &mut self.residuals)
    }
}

/// Log-likelihood of all pixels about their colour means, independent of the light.
pub(crate) fn log_within(
    sums: &[PixelSums],
    params: &PixelLikelihoodParams,
    noise: &Vector3<f64>,
    n_pixels: usize,
) -> LogWeight {
    let scatter = |sums: &PixelSums| Region::new(sums, log_scatter(sums, noise));
    params.log_likelihood(n_pixels, sums.iter().map(scatter))
}

/// $`\sum_c \ln N(c; \bar c, ν + \hat S)`$ about the pixels' own mean: the `noise` and the scatter that they have.
fn log_scatter(sums: &PixelSums, noise: &Vector3<f64>) -> f64 {
    let Some(mean) = sums.mean() else { return 0.0 };
    let n = sums.count() as f64;
    let scatter = sums.scatter_about(&mean);
    let covariance = Matrix3::from_diagonal(noise) + scatter / n;
    let Some(factor) = covariance.cholesky() else { return f64::NEG_INFINITY };
    let log_root = factor.l_dirty().diagonal().product().ln();
    n * (-1.5 * std::f64::consts::TAU.ln() - log_root) - 0.5 * factor.inverse().dot(&scatter)
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
