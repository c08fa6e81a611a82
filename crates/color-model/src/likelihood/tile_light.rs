use nalgebra::{DMatrix, DVector, Vector3};
use wayfix_estimation_traits::LogWeight;
use wayfix_kalman::update_component;

use super::{PixelLikelihoodParams, tiles::TileRegionColor};
use crate::{ColorModelError, LightingTracker};

/// A light: mean and variance of the pixels of each colour, $`\operatorname{diag} Σ_{mm} + ν + σ^2 s_m s_m^\top`$.
#[derive(Clone, Debug)]
pub(crate) struct TileLight(Vec<ColorOfTile>);

#[derive(Clone, Debug)]
struct ColorOfTile {
    mean: Vector3<f64>,
    variance: Vector3<f64>,
    information: Vector3<f64>,
    log_peak: f64,
}

impl TileLight {
    /// A light of a tracker.
    pub(crate) fn new(
        light: &impl LightingTracker,
        at: usize,
        params: &PixelLikelihoodParams,
        noise: &Vector3<f64>,
    ) -> Result<Self, ColorModelError> {
        if let Some((mean, covariance)) = light.joint_belief(at) {
            return Ok(Self::of(mean, Some(covariance), params, noise));
        }
        let color = |color: crate::ColorDensity| {
            ColorOfTile::new(color.mean, color.covariance.diagonal() + params.shade(&color.mean).diagonal())
        };
        Ok(Self(light.colors_in(at)?.into_iter().map(color).collect()))
    }

    /// With this mean and covariance of all colours.
    pub(super) fn of(
        mean: &DVector<f64>,
        covariance: Option<&DMatrix<f64>>,
        params: &PixelLikelihoodParams,
        noise: &Vector3<f64>,
    ) -> Self {
        let color = |row: usize| {
            let variance = |at| covariance.map_or(0.0, |covariance| covariance[(row + at, row + at)]);
            let mean = mean.fixed_rows::<3>(row).into_owned();
            let uneven = params.shade(&mean).diagonal();
            ColorOfTile::new(mean, noise + uneven + Vector3::from_fn(|at, _| variance(at)))
        };
        Self((0..mean.len() / 3).map(|at| color(3 * at)).collect())
    }

    /// The belief about a light after it shone on some regions of these weights, and the logarithm of the density of its mean under the belief, times the volume of the
    /// posterior over that of the belief. [MacKay 2003, 28.1]
    pub(crate) fn learned(
        (mean, covariance): (&DVector<f64>, &DMatrix<f64>),
        regions: impl Iterator<Item = (f64, Vector3<f64>, usize)>,
        params: &PixelLikelihoodParams,
        (noise, mean_noise): (&Vector3<f64>, &Vector3<f64>),
    ) -> (Self, LogWeight) {
        let mut seen = vec![(0.0, Vector3::zeros()); mean.len() / 3];
        for (weight, color_mean, color) in regions.filter(|(weight, ..)| weight.is_finite()) {
            if let Some((sum, mean)) = seen.get_mut(color) {
                *sum += weight;
                *mean += color_mean * weight;
            }
        }
        let (mut mean, mut covariance) = (mean.clone(), covariance.clone());
        let log = learn(&mut mean, &mut covariance, &seen, &(noise + mean_noise));
        (Self::of(&mean, None, params, noise), log)
    }

    /// Mean of a colour.
    #[cfg(test)]
    pub(super) fn mean(&self, color: usize) -> &Vector3<f64> {
        &self.0[color].mean
    }

    /// $`\ln N(c; μ_m, Σ_{mm} + ν + B)`$ on average over the pixels of a tile. The pose and blur move the edges within a tile, so that a pixel may show the colour beyond one:
    /// $`B`$ is the variance between the colours of the tile, 0 if it has one.
    pub(super) fn log_density(&self, regions: &[TileRegionColor]) -> f64 {
        let colors = || regions.iter().filter_map(|region| Some((region, self.0.get(region.color)?)));
        if let [_] = regions {
            return colors().map(|(region, color)| color.log_density(region)).sum();
        }
        let mean: Vector3<f64> = colors().map(|(region, color)| color.mean * region.share).sum();
        let between: Vector3<f64> =
            colors().map(|(region, color)| squared(color.mean - mean) * region.share).sum();
        let log_density = |(region, color): (&TileRegionColor, &ColorOfTile)| {
            region.share * color.widened(&between).log_density(region)
        };
        colors().map(log_density).sum()
    }
}

impl ColorOfTile {
    fn new(mean: Vector3<f64>, variance: Vector3<f64>) -> Self {
        let log_peak = -0.5 * variance.map(|v| std::f64::consts::TAU * v).product().ln();
        Self { mean, variance, information: variance.map(f64::recip), log_peak }
    }

    fn widened(&self, variance: &Vector3<f64>) -> Self {
        Self::new(self.mean, self.variance + variance)
    }

    /// On average over the pixels of a region.
    fn log_density(&self, region: &TileRegionColor) -> f64 {
        self.log_peak
            - 0.5 * (squared(region.pixels.mean - self.mean) + region.pixels.scatter).dot(&self.information)
    }
}

fn squared(vector: Vector3<f64>) -> Vector3<f64> {
    vector.component_mul(&vector)
}

/// Updates a light with what it shines on, $`N(\bar c; θ, (ν + R) / w)`$ of weight $`w`$. Returns the density of its mean under the belief, times the volume of the posterior
/// over that of the belief, as a logarithm.
fn learn(
    mean: &mut DVector<f64>,
    covariance: &mut DMatrix<f64>,
    seen: &[(f64, Vector3<f64>)],
    variance: &Vector3<f64>,
) -> LogWeight {
    let seen = || {
        let seen = seen.iter().enumerate().filter(|(_, (weight, _))| *weight > f64::EPSILON);
        seen.flat_map(|(color, (weight, sum))| {
            (0..3).map(move |at| (3 * color + at, sum[at] / weight, variance[at] / weight))
        })
    };
    let mut log = 0.0;
    for (row, value, variance) in seen() {
        log += update_component(mean, covariance, row, value, variance).unwrap_or(f64::NEG_INFINITY);
        log += 0.5 * (std::f64::consts::TAU * variance).ln();
    }
    log + seen().map(|(row, value, variance)| 0.5 * (value - mean[row]).powi(2) / variance).sum::<f64>()
}
