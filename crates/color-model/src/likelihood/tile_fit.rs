//! The lights that a set of tiles shows.

use nalgebra::{DMatrix, DVector, Vector3};
use wayfix_estimation_traits::LogWeight;

use super::{PixelLikelihoodFrame, PixelLikelihoodParams, TileLight, TileLikelihood, tiles::TileRegionColor};

/// Steps of expectation maximization: the first one from the beliefs and the brightness of the tiles, the second one from the first.
const N_FIT_STEPS: usize = 2;

impl TileLikelihood {
    /// Some lights after expectation maximization [Dempster et al. 1977] on all tiles, which are [weighed](Self::weigh) in them then, and the logarithm of their density, as of [`TileLight::learned`]. It begins with the
    /// tiles that show the map by the beliefs; of two lights, the first one begins with the brighter ones.
    pub(crate) fn fit(
        &mut self,
        beliefs: &[(&DVector<f64>, &DMatrix<f64>)],
        params: &PixelLikelihoodParams,
        frame: &PixelLikelihoodFrame,
    ) -> (Vec<TileLight>, LogWeight) {
        let noise = (&frame.pixel_color_variance, &frame.mean_color_variance);
        let predicted =
            |(mean, covariance): &(&_, &_)| TileLight::of(mean, Some(covariance), params, noise.0);
        self.weigh(&beliefs.iter().map(predicted).collect::<Vec<_>>());
        let odds = (1.0 - params.outlier_share) / params.outlier_share;
        let mut shares: Vec<f64> =
            self.ratios.iter().map(|ratio| 1.0 / (1.0 + 1.0 / (odds * ratio))).collect();
        if beliefs.len() == 2 {
            for (shares, bright) in shares.chunks_exact_mut(beliefs.len()).zip(self.brightness()) {
                shares[usize::from(bright > 1.0)] = 0.0;
            }
        }
        let mut fitted = (Vec::new(), 0.0);
        for step in 0..N_FIT_STEPS {
            if step > 0 {
                self.shares(beliefs.len(), params.outlier_share, &mut shares);
            }
            let learned = beliefs.iter().enumerate().map(|(at, belief)| {
                TileLight::learned(*belief, self.weighted(&shares, (at, beliefs.len())), params, noise)
            });
            let (lights, logs): (Vec<_>, Vec<_>) = learned.unzip();
            self.weigh(&lights);
            fitted = (lights, logs.iter().sum());
        }
        fitted
    }

    /// Brightness of each tile, as a share of the mean of its colours.
    fn brightness(&self) -> Vec<f64> {
        let n_colors = self.regions.iter().map(|region| region.color + 1).max().unwrap_or(0);
        let mut means = vec![(0.0, 0.0); n_colors];
        for region in &self.regions {
            let (sum, weight) = &mut means[region.color];
            *sum += region.share * region.pixels.mean.x;
            *weight += region.share;
        }
        let relative = |region: &TileRegionColor| {
            let (sum, weight) = means[region.color];
            region.share * region.pixels.mean.x * weight / sum.max(f64::MIN_POSITIVE)
        };
        let mut start = 0;
        let tiles = self.tiles.iter().map(|tile| {
            let regions = &self.regions[start..tile.end];
            start = tile.end;
            regions.iter().map(relative).sum()
        });
        tiles.collect()
    }

    /// Weight, mean and colour of all regions in a light.
    fn weighted<'a>(
        &'a self,
        shares: &'a [f64],
        (light, n_lights): (usize, usize),
    ) -> impl Iterator<Item = (f64, Vector3<f64>, usize)> + 'a {
        let starts = std::iter::once(0).chain(self.tiles.iter().map(|tile| tile.end));
        starts.zip(&self.tiles).zip(shares.chunks_exact(n_lights)).flat_map(move |((start, tile), shares)| {
            let weight = tile.weight * shares[light];
            let regions = self.regions[start..tile.end].iter();
            regions.map(move |region| (weight * region.share, region.pixels.mean, region.color))
        })
    }

    /// Probability of each light in each tile.
    fn shares(&self, n_lights: usize, outlier_share: f64, shares: &mut Vec<f64>) {
        shares.clear();
        let prior = (1.0 - outlier_share) / n_lights as f64;
        for ratios in self.ratios.chunks_exact(n_lights) {
            let sum = prior * ratios.iter().sum::<f64>() + outlier_share;
            shares.extend(ratios.iter().map(|ratio| prior * ratio / sum));
        }
    }
}

#[cfg(test)]
mod tests {
    use approx::assert_abs_diff_eq;

    use super::*;
    use crate::{
        LightingFilterParams, LightingTracker,
        likelihood::tiles::tests::{filter, tiles},
    };

    #[test]
    fn a_fitted_light_is_that_of_the_tiles() {
        let (params, filter) = (PixelLikelihoodParams::default(), filter(100.0, 30.0));
        let LightingFilterParams { pixel_color_variance, mean_color_variance, .. } = filter.noise();
        let frame = PixelLikelihoodFrame { pixel_color_variance, mean_color_variance };
        let fitted = |pixels: &[[[u8; 3]; 4]], n: usize| {
            let (image, sums) = tiles(pixels);
            let mut tiles = TileLikelihood::default();
            tiles.add_tiles(&image, sums.regions(), 1.0);
            let belief = filter.joint_belief(0).unwrap();
            let (lights, log_density) = tiles.fit(&vec![belief; n], &params, &frame);
            (lights.iter().map(|light| light.mean(0).x).collect::<Vec<_>>(), log_density)
        };
        let variance = (pixel_color_variance + mean_color_variance).x;
        // Fifty means against a prior of variance 900.
        let gain = 900.0 / (900.0 + variance / 50.0);
        let (means, log_density) = fitted(&[[[130, 128, 128]; 4]; 50], 1);
        assert_abs_diff_eq!(means[0], 100.0 + gain * 30.0, epsilon = 0.1); // few tiles may show something else
        let (_, at_the_mean) = fitted(&[[[100, 128, 128]; 4]; 50], 1);
        let expected = 0.5 * (gain * 30.0_f64).powi(2) / 900.0; // of the fitted mean under the prior
        assert_abs_diff_eq!(at_the_mean - log_density, expected, epsilon = 0.05);
        let pixels: Vec<_> = (0..50).map(|at| [[if at % 2 == 0 { 160 } else { 60 }, 128, 128]; 4]).collect();
        let (means, _) = fitted(&pixels, 2);
        assert!((means[0] - 160.0).abs() < 5.0 && (means[1] - 60.0).abs() < 5.0, "{means:?}");
    }
}
