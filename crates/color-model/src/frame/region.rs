//! What the likelihood asks of the pixels of a colour in a tile.

use nalgebra::Vector3;

use super::{PixelSums, TileRegion};

/// Mean and scatter of the pixels of a colour in a tile.
#[derive(Clone, Copy, Debug)]
pub(crate) struct RegionStatistics {
    pub(crate) n_pixels: f64,
    pub(crate) mean: Vector3<f64>,
    /// Variance of the pixels about their mean.
    pub(crate) scatter: Vector3<f64>,
    /// $`-\ln p_{bg}`$ of a pixel on average.
    pub(crate) background: f64,
}

impl RegionStatistics {
    fn new(sums: &PixelSums) -> Self {
        let n_pixels = sums.count() as f64;
        Self {
            n_pixels,
            mean: sums.mean().unwrap_or_default(),
            scatter: sums.variance(),
            background: sums.background_nats() / n_pixels,
        }
    }
}

/// Log-likelihood ratio of the scatter within a region, a pixel, of edges against one surface: linear in the scatter.
#[derive(Clone, Debug, Default)]
struct ScatterRatio {
    at_zero: f64,
    slope: Vector3<f64>,
}

impl ScatterRatio {
    /// The variance of the pixels of a surface, and of a tile with edges.
    fn new([surface, edges]: [Vector3<f64>; 2]) -> Self {
        Self {
            at_zero: 0.5 * surface.zip_map(&edges, |surface, edges| (surface / edges).ln()).sum(),
            slope: 0.5 * (surface.map(f64::recip) - edges.map(f64::recip)),
        }
    }

    fn log_ratio(&self, scatter: &Vector3<f64>) -> f64 {
        -(0.5 + 0.5 * (self.at_zero + self.slope.dot(scatter)).exp()).ln()
    }
}

/// The tiles of an image as regions that fill them: most regions do.
#[derive(Clone, Debug, Default)]
pub(super) struct WholeTiles {
    tiles: Vec<WholeTile>,
    scatter: ScatterRatio,
}

#[derive(Clone, Debug)]
struct WholeTile {
    pixels: RegionStatistics,
    log_ratio_of_scatter: f64,
}

impl WholeTiles {
    /// From all pixels of each tile.
    pub(super) fn new(tiles: &[PixelSums]) -> Self {
        let scatter = ScatterRatio::new(scatters(tiles));
        let tile = |sums: &PixelSums| {
            let pixels = RegionStatistics::new(sums);
            WholeTile { log_ratio_of_scatter: scatter.log_ratio(&pixels.scatter), pixels }
        };
        Self { tiles: tiles.iter().map(tile).collect(), scatter }
    }

    pub(super) fn n_pixels(&self, tile: usize) -> f64 {
        self.tiles[tile].pixels.n_pixels
    }

    #[inline]
    pub(super) fn statistics(&self, region: &TileRegion<'_>) -> RegionStatistics {
        let WholeTile { pixels, .. } = &self.tiles[region.tile];
        if region.n_pixels() == pixels.n_pixels { *pixels } else { RegionStatistics::new(&region.sums()) }
    }

    /// Log-likelihood ratio of the scatter within a region of a tile, a pixel: of one surface against any tile of the image. Half of the tiles have the median or less and
    /// show one surface; so no region gains more than a factor of 2.
    pub(super) fn log_ratio_of_scatter(&self, tile: usize, region: &RegionStatistics) -> f64 {
        let WholeTile { pixels, log_ratio_of_scatter } = &self.tiles[tile];
        let is_whole = region.n_pixels == pixels.n_pixels;
        if is_whole { *log_ratio_of_scatter } else { self.scatter.log_ratio(&region.scatter) }
    }
}

/// Median and mean over the tiles of the variance of their pixels. Most tiles show one surface; the mean contains edges too.
fn scatters(tiles: &[PixelSums]) -> [Vector3<f64>; 2] {
    let scatters: Vec<Vector3<f64>> = tiles.iter().map(PixelSums::variance).collect();
    let mean = scatters.iter().sum::<Vector3<f64>>() / scatters.len().max(1) as f64;
    let median = Vector3::from_fn(|channel, _| {
        let mut values: Vec<f64> = scatters.iter().map(|scatter| scatter[channel]).collect();
        values.sort_by(f64::total_cmp);
        values.get(values.len() / 2).copied().unwrap_or(0.0)
    });
    // Values are whole numbers: rounding alone has 1/12.
    [median, mean].map(|scatter| scatter.add_scalar(1.0 / 12.0))
}
