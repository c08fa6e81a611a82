use wayfix_estimation_traits::LogWeight;
use wayfix_gaussian_core::log_sum_exp;

use super::{PixelLikelihoodParams, TileLight};
use crate::{PixelSums, TileRegion, TiledImage, frame::RegionStatistics};

/// So many tiles are multiplied before a logarithm: their ratios, at most e⁵⁰ or so, fit a double.
const N_MULTIPLIED: usize = 8;
/// Shares of the tiles that show something else, about a tenth, half and nine tenths, and the weights of Gauss-Legendre quadrature: a coarse integral over all shares.
/// [Abramowitz & Stegun 1964, 25.4.29]
const OUTLIER_SHARES: [(f64, f64); 3] =
    [(0.112_701_665, 5.0 / 18.0), (0.5, 8.0 / 18.0), (0.887_298_335, 5.0 / 18.0)];

/// The likelihood of an image in which every tile has a hidden light, as where the sun shines on a part of the floor.
///
/// All tiles $`t`$ are in one light $`j`$, or some are in its shade $`s`$, or a tile shows something else, as a ball or a person:
/// ```math
/// p(z | x, j) = \frac{1}{2} \int_0^1 \! dε\, p(u) \prod_t \big[ (1 - ε)\, r_{tj} + ε \big]
///   + \frac{1}{2} \int_0^1 \! dε\, p(u) \prod_t \big[ (1 - ε)\, \tfrac{1}{2} (r_{tj} + r_{ts}) + ε \big], \quad
/// r_{tj} = \Big[ q_t \prod_m \prod_{c ∈ (t, m)} \frac{N(c; μ_j[m], V_{jm} + B_t)}{p_{bg}(c)} \Big]^{1/n_t}
/// ```
///
/// $`V_{jm} = \operatorname{diag}(Σ_j[m,m] + ν + σ^2 s_m s_m^\top)`$ has the uneven light of [`PixelLikelihoodParams::shaded`]. $`B_t`$ is the variance between the colours of the tile.
/// $`q_t`$, for a tile of one colour, is the likelihood ratio of the scatter of its pixels between a surface and the background; else it is 1.
///
/// This is [Schulz & Fox 2004, Eqs. 9, 16] with the $`n_t`$ mapped pixels of a tile as one observation: they share shade and errors of the pose. Their sums suffice. A label that
/// fits every pixel of an image gains nothing over its average, the background. $`p(u)`$ is the likelihood of
/// the tiles that do not show the map: each with the probability that it shows something else.
#[derive(Default)]
pub(crate) struct TileLikelihood {
    pub(super) regions: Vec<TileRegionColor>,
    pub(super) tiles: Vec<Tile>,
    /// $`r_{tj}`$, tile by tile.
    pub(super) ratios: Vec<f64>,
    /// Tiles that do not show the map, cell by cell.
    unmapped: Vec<f64>,
}

/// A tile that shows the map.
pub(super) struct Tile {
    /// End of its regions.
    pub(super) end: usize,
    /// Number in its image.
    number: usize,
    /// Share of its pixels that the map shows.
    mapped: f64,
    /// When a light is fitted.
    pub(super) weight: f64,
}

/// The pixels of a colour in a tile.
pub(crate) struct TileRegionColor {
    pub(super) color: usize,
    /// Share of the pixels of the tile.
    pub(super) share: f64,
    /// The background of a region that is alone in its tile includes the likelihood ratio of its scatter.
    pub(super) pixels: RegionStatistics,
}

/// A light of a tracker, and its shade.
#[derive(Clone, Copy, Debug)]
pub(crate) struct LightOfTiles {
    pub(crate) light: usize,
    pub(crate) shade: Option<usize>,
    pub(crate) n_lights: usize,
}

impl TileLikelihood {
    /// Number of tiles that show the map.
    pub(crate) fn n_tiles(&self) -> usize {
        self.tiles.len()
    }

    /// Forgets all tiles.
    pub(crate) fn clear(&mut self) {
        self.regions.clear();
        self.tiles.clear();
    }

    /// Adds the tiles of an image, each with this weight when a light is fitted.
    pub(crate) fn add_tiles<'a>(
        &mut self,
        image: &TiledImage,
        regions: impl Iterator<Item = TileRegion<'a>>,
        weight: f64,
    ) {
        let mut number = None;
        for region in regions {
            if let Some(last) = number.replace(region.tile)
                && last != region.tile
            {
                self.end_tile(image, last, weight);
            }
            let pixels = image.statistics(&region);
            self.regions.push(TileRegionColor { color: region.color, share: pixels.n_pixels, pixels });
        }
        if let Some(last) = number {
            self.end_tile(image, last, weight);
        }
    }

    fn end_tile(&mut self, image: &TiledImage, number: usize, weight: f64) {
        let start = self.tiles.last().map_or(0, |tile| tile.end);
        let n_pixels: f64 = self.regions[start..].iter().map(|region| region.share).sum();
        self.regions[start..].iter_mut().for_each(|region| region.share /= n_pixels);
        // Several colours scatter about their edge.
        if let [region] = &mut self.regions[start..] {
            region.pixels.background += image.log_ratio_of_scatter(number, &region.pixels);
        }
        let mapped = n_pixels / image.n_pixels(number);
        self.tiles.push(Tile { end: self.regions.len(), number, mapped, weight });
    }

    /// Computes the likelihood ratio of each tile in each light.
    pub(crate) fn weigh(&mut self, lights: &[TileLight]) {
        let Self { regions, tiles, ratios, .. } = self;
        ratios.clear();
        let mut start = 0;
        for Tile { end, .. } in tiles {
            let regions = &regions[start..*end];
            let background: f64 = regions.iter().map(|region| region.share * region.pixels.background).sum();
            ratios.extend(lights.iter().map(|light| (light.log_density(regions) + background).exp()));
            start = *end;
        }
    }

    /// The log-likelihood of an image, which has these tiles, in a light, and whether some of them are rather in its shade.
    pub(crate) fn log_likelihood(
        &mut self,
        image: &TiledImage,
        LightOfTiles { light, shade, n_lights }: LightOfTiles,
        tiles: std::ops::Range<usize>,
    ) -> (LogWeight, bool) {
        let even = self.log_likelihood_of(image, (&tiles, n_lights), |ratios| ratios[light]);
        let Some(shade) = shade else { return (even, false) };
        let mean = |ratios: &[f64]| 0.5 * (ratios[light] + ratios[shade]);
        let uneven = self.log_likelihood_of(image, (&tiles, n_lights), mean);
        (log_sum_exp(&[even, uneven]) - std::f64::consts::LN_2, uneven > even)
    }

    /// The log-likelihood of an image if a tile that shows the map has this likelihood ratio. Tiles that show something else are background, and any share of them is as
    /// probable: a robot near by covers half of a view.
    fn log_likelihood_of(
        &mut self,
        image: &TiledImage,
        (range, n_lights): (&std::ops::Range<usize>, usize),
        ratio: impl Fn(&[f64]) -> f64 + Clone,
    ) -> LogWeight {
        let Self { tiles, ratios, unmapped, .. } = self;
        let (tiles, ratios) = (&tiles[range.clone()], ratios.chunks_exact(n_lights.max(1)).skip(range.start));
        let ratios = ratios.take(tiles.len()).map(ratio);
        log_sum_exp(&OUTLIER_SHARES.map(|(outlier_share, weight)| {
            let shown = ratios.clone().map(|ratio| (1.0 - outlier_share) * ratio);
            let log = weight.ln() + log_product(shown.clone().map(|shown| shown + outlier_share));
            let Some(colors) = image.unmapped_colors() else { return log };
            let probability = |shown: f64| shown / (shown + outlier_share);
            let mapped =
                tiles.iter().zip(shown).map(|(tile, shown)| (tile.number, tile.mapped * probability(shown)));
            log + colors.log_ratio(mapped, unmapped)
        }))
    }

    /// The number of each tile in its image, and what it adds to the log-likelihood of the image.
    pub(crate) fn gains(
        &mut self,
        image: &TiledImage,
        lights: LightOfTiles,
        tiles: std::ops::Range<usize>,
    ) -> Vec<(usize, LogWeight)> {
        let (all, _) = self.log_likelihood(image, lights, tiles.clone());
        let last = tiles.end.saturating_sub(1);
        let gain = |tile: usize| {
            self.swap(tile, last, lights.n_lights);
            let (others, _) = self.log_likelihood(image, lights, tiles.start..last);
            self.swap(tile, last, lights.n_lights);
            (self.tiles[tile].number, all - others)
        };
        tiles.clone().map(gain).collect()
    }

    fn swap(&mut self, one: usize, other: usize, n_lights: usize) {
        self.tiles.swap(one, other);
        (0..n_lights).for_each(|light| self.ratios.swap(one * n_lights + light, other * n_lights + light));
    }

    /// Adds the pixels of each tile to its light, unless it shows something else; `shown` has all colours of the first light, then those of the next. All tiles are in the
    /// light, or each in the more probable one of light and shade.
    pub(crate) fn show<'a>(
        &self,
        regions: impl Iterator<Item = TileRegion<'a>>,
        LightOfTiles { light, shade, n_lights }: LightOfTiles,
        params: &PixelLikelihoodParams,
        shown: &mut [PixelSums],
    ) {
        let n_colors = shown.len() / n_lights.max(1);
        let lights = [Some(light), shade];
        let n_shown = lights.iter().flatten().count() as f64;
        let something_else = params.outlier_share * n_shown / (1.0 - params.outlier_share);
        let (mut tile, mut at) = (None, 0);
        for region in regions {
            at += usize::from(tile.replace(region.tile).is_some_and(|last| last != region.tile));
            let ratios = lights.iter().flatten().map(|light| (*light, self.ratios[at * n_lights + light]));
            let best = ratios.max_by(|a, b| a.1.total_cmp(&b.1)).filter(|(_, ratio)| *ratio > something_else);
            if let Some((light, _)) = best
                && let Some(sums) = shown.get_mut(light * n_colors + region.color)
            {
                sums.add(&region.sums());
            }
        }
    }
}

/// Logarithm of a product.
fn log_product(mut factors: impl Iterator<Item = f64>) -> LogWeight {
    let mut log = 0.0;
    loop {
        let mut n = 0;
        let product: f64 = factors.by_ref().take(N_MULTIPLIED).inspect(|_| n += 1).product();
        log += product.ln();
        if n < N_MULTIPLIED {
            return log;
        }
    }
}

#[cfg(test)]
pub(super) mod tests {
    use approx::assert_abs_diff_eq;
    use nalgebra::{DMatrix, DVector, Vector3};
    use wayfix_gaussian_core::Gaussian;

    use super::*;
    use crate::{LightingFilter, LightingFilterParams, TileSums, YuvImage};

    const NATS: f64 = 10.0;

    /// Tiles of 2 × 2 pixels of one colour.
    pub(in super::super) fn tiles(pixels: &[[[u8; 3]; 4]]) -> (TiledImage, TileSums) {
        let rows = [[0, 1], [2, 3]].map(|row| pixels.iter().flat_map(move |tile| row.map(|at| tile[at])));
        let image = YuvImage::new(2 * pixels.len() as u32, 2, rows.into_iter().flatten().collect()).unwrap();
        let image = TiledImage::new(&image, 2, |_| NATS).unwrap();
        let mut sums = TileSums::new(&image, 1);
        (0..2).for_each(|row| sums.add_run(&image, (row, 0, 2 * pixels.len()), 0));
        sums.add_covered_rows(&image);
        (image, sums)
    }

    pub(in super::super) fn filter(y: f64, sigma: f64) -> LightingFilter {
        let variance = sigma * sigma;
        let prior = Gaussian::new(
            DVector::from_vec(vec![y, 128.0, 128.0]),
            DMatrix::from_diagonal(&DVector::from_vec(vec![variance, 25.0, 25.0])),
        );
        LightingFilter::new(prior.unwrap(), LightingFilterParams::default()).unwrap()
    }

    fn light(y: f64, params: &PixelLikelihoodParams) -> TileLight {
        TileLight::new(&filter(y, 1.0), 0, params, &Vector3::new(25.0, 9.0, 9.0)).unwrap()
    }

    const SHADED: LightOfTiles = LightOfTiles { light: 0, shade: Some(1), n_lights: 2 };

    #[test]
    fn a_tile_counts_as_its_mean_pixel() {
        let pixels = [[90, 118, 130], [96, 122, 130], [90, 122, 126], [96, 118, 126]];
        let params = PixelLikelihoodParams { brightness_variation: 0.0, ..Default::default() };
        let (image, sums) = tiles(&[pixels]);
        let mut tiles = TileLikelihood::default();
        tiles.add_tiles(&image, sums.regions(), 1.0);
        tiles.weigh(&[light(100.0, &params)]);
        let in_light = LightOfTiles { light: 0, shade: None, n_lights: 1 };
        let (value, is_shaded) = tiles.log_likelihood(&image, in_light, 0..1);
        let normal = |x: f64, v: f64| -0.5 * (x * x / v + (std::f64::consts::TAU * v).ln());
        let variances = [26.0, 34.0, 34.0]; // of the light and of a pixel
        let pixel = |pixel: &[u8; 3]| -> f64 {
            (0..3).map(|at| normal(f64::from(pixel[at]) - [100.0, 128.0, 128.0][at], variances[at])).sum()
        };
        // The only tile has the median scatter and the mean one.
        let ratio = (pixels.iter().map(pixel).sum::<f64>() / 4.0 + NATS).exp();
        // The mean over all shares of what is something else; the background is rounded.
        assert_abs_diff_eq!(value, (0.5 * ratio + 0.5).ln(), epsilon = 1e-4);
        assert!(!is_shaded);
    }

    /// In the second row the edge is a pixel to the left of where the map has it.
    #[test]
    fn a_tile_with_an_edge_is_as_wide_as_its_colours_differ() {
        let params = PixelLikelihoodParams { brightness_variation: 0.0, ..Default::default() };
        let (dark, bright) = ([60, 128, 128], [160, 128, 128]);
        let image = YuvImage::new(2, 2, vec![dark, bright, bright, bright]).unwrap();
        let image = TiledImage::new(&image, 2, |_| NATS).unwrap();
        let mut sums = TileSums::new(&image, 2);
        for row in 0..2 {
            sums.add_run(&image, (row, 0, 1), 0);
            sums.add_run(&image, (row, 1, 2), 1);
        }
        let mean = DVector::from_iterator(6, [dark, bright].concat().into_iter().map(f64::from));
        let light = TileLight::of(&mean, None, &params, &Vector3::new(25.0, 9.0, 9.0));
        let mut tiles = TileLikelihood::default();
        tiles.add_tiles(&image, sums.regions(), 1.0);
        tiles.weigh(&[light]);
        let variances = [25.0 + 50.0_f64.powi(2), 9.0, 9.0]; // each colour is 50 off the mean of the tile
        let peak: f64 = variances.iter().map(|v| -0.5 * (std::f64::consts::TAU * v).ln()).sum();
        let one_of_four = -0.5 * 100.0_f64.powi(2) / variances[0] / 4.0;
        assert_abs_diff_eq!(tiles.ratios[0].ln(), peak + one_of_four + NATS, epsilon = 1e-4);
    }

    #[test]
    fn each_tile_is_in_the_sun_or_in_the_shade() {
        let params = PixelLikelihoodParams { brightness_variation: 0.0, ..Default::default() };
        let (bright, dark) = ([[192, 128, 128]; 4], [[52, 128, 128]; 4]);
        let (image, sums) = tiles(&[bright, dark, dark]);
        let mut tiles = TileLikelihood::default();
        tiles.add_tiles(&image, sums.regions(), 1.0);
        tiles.weigh(&[light(200.0, &params), light(60.0, &params)]);
        let alone = tiles.log_likelihood(&image, LightOfTiles { shade: None, ..SHADED }, 0..3).0;
        let (shaded, is_shaded) = tiles.log_likelihood(&image, SHADED, 0..3);
        assert!(is_shaded && shaded > alone);
        let (_, is_shaded) = tiles.log_likelihood(&image, SHADED, 0..1);
        assert!(!is_shaded); // the first tile alone
        let mut shown = [PixelSums::default(); 2];
        tiles.show(sums.regions(), SHADED, &params, &mut shown);
        assert_eq!(shown.map(|sums| sums.mean().map(|mean| mean.x)), [Some(192.0), Some(52.0)]);
        let mut shown = [PixelSums::default(); 2];
        tiles.show(sums.regions(), LightOfTiles { shade: None, ..SHADED }, &params, &mut shown);
        assert_eq!(shown.map(|sums| sums.count()), [4, 0]); // the others show something else
    }

    #[test]
    fn the_gain_of_a_tile_is_what_an_image_without_it_lacks() {
        let params = PixelLikelihoodParams::default();
        let (image, sums) = tiles(&[[[192, 128, 128]; 4], [[52, 128, 128]; 4], [[150, 120, 128]; 4]]);
        let mut tiles = TileLikelihood::default();
        tiles.add_tiles(&image, sums.regions(), 1.0);
        tiles.weigh(&[light(200.0, &params), light(60.0, &params)]);
        let gains = tiles.gains(&image, SHADED, 0..3);
        let [all, first, last] =
            [0..3, 1..3, 0..2].map(|range| tiles.log_likelihood(&image, SHADED, range).0);
        assert_eq!(gains[0], (0, all - first));
        assert_eq!(gains[2], (2, all - last));
    }

    #[test]
    fn a_product_of_many_tiles_does_not_overflow() {
        assert_abs_diff_eq!(log_product((0..1000).map(|_| 50_f64.exp())), 50_000.0, epsilon = 1e-6);
        assert_eq!(log_product(std::iter::empty()), 0.0);
    }
}
