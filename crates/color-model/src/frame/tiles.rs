use super::{PixelSums, PrefixSumImage, sums::LANES, unmapped::UnmappedColors};
use nalgebra::Vector3;

use crate::{ColorModelError, YuvImage};

/// An image as sums, divided into square tiles: sums of any run of pixels, and of any rows of a tile.
#[derive(Clone, Debug)]
pub struct TiledImage {
    pixels: PrefixSumImage,
    side: usize,
    columns: usize,
    /// Sums of each column of tiles from the first row up to each row.
    down: Vec<[u32; LANES]>,
    scatter: ScatterRatio,
    /// Unless the background is known.
    unmapped: Option<UnmappedColors>,
}

/// The pixels of one colour in one tile.
#[derive(Clone, Copy, Debug)]
pub struct TileRegion {
    /// Number of the tile, row by row.
    pub tile: usize,
    /// Index of the colour in the map.
    pub color: usize,
    /// Its pixels.
    pub sums: PixelSums,
}

/// Sums of every colour in every tile of an image.
///
/// ```
/// use wayfix_color_model::{TileSums, TiledImage, YuvImage};
/// let image = TiledImage::new(&YuvImage::new(4, 1, vec![[10, 128, 128]; 4])?, 2, |_| 0.0)?;
/// let mut tiles = TileSums::new(&image, 1); // two tiles of 2 pixels a side
/// tiles.add_run(&image, (0, 1, 4), 0);
/// tiles.add_covered_rows(&image);
/// let counts: Vec<u64> = tiles.regions().map(|region| region.sums.count()).collect();
/// assert_eq!(counts, [1, 2]); // a run is split at the border of the tiles
/// # Ok::<(), wayfix_color_model::ColorModelError>(())
/// ```
#[derive(Clone, Debug)]
pub struct TileSums {
    side: usize,
    columns: usize,
    n_colors: usize,
    /// Of each tile and colour, and the rows of the tile that the colour covers, a bit each.
    sums: Vec<([u32; LANES], u64)>,
    /// Which of the sums a run reached, a bit each: a view shows few colours in a tile.
    reached: Vec<u64>,
}

/// Positions of the bits, in order.
fn bits(words: &[u64]) -> impl Iterator<Item = usize> + Clone {
    let of_word = |(at, word): (usize, &u64)| {
        let mut left = *word;
        std::iter::from_fn(move || {
            let bit = (left != 0).then(|| at * u64::BITS as usize + left.trailing_zeros() as usize);
            left &= left.wrapping_sub(1);
            bit
        })
    };
    words.iter().enumerate().flat_map(of_word)
}

/// Adds what lies between two prefix sums.
fn add(sums: &mut [u32; LANES], upto: &[u32; LANES], before: &[u32; LANES]) {
    for lane in 0..LANES {
        sums[lane] = sums[lane].wrapping_add(upto[lane].wrapping_sub(before[lane]));
    }
}

impl TiledImage {
    /// Widest side of a tile, pixels: the sums of 62 × 62 pixels fit 32 bits, with at most 16.8 nats of background each.
    pub const MAX_SIDE: u16 = 62;

    /// The sums of all pixels with the background terms $`-\ln p_{bg}(c)`$ given by `nats`; `side` is that of a tile, at most [`MAX_SIDE`](Self::MAX_SIDE).
    ///
    /// # Errors
    /// As for [`PrefixSumImage::new`].
    pub fn new(
        image: &YuvImage,
        side: u16,
        mut nats: impl FnMut([u8; 3]) -> f64,
    ) -> Result<Self, ColorModelError> {
        let pixels = PrefixSumImage::with_background(image, |pixel| Some(nats(pixel)))?;
        let side = usize::from(side.clamp(1, Self::MAX_SIDE));
        let columns = pixels.width().div_ceil(side);
        let mut down = Vec::with_capacity(columns * (pixels.height() + 1));
        for column in 0..columns {
            let (start, end) = (column * side, ((column + 1) * side).min(pixels.width()));
            let mut sums = [0; LANES];
            down.push(sums);
            for row in 0..pixels.height() {
                let prefix = pixels.prefix_sums(row);
                add(&mut sums, &prefix[end], &prefix[start]);
                down.push(sums);
            }
        }
        let mut tiled =
            Self { pixels, side, columns, down, scatter: ScatterRatio::default(), unmapped: None };
        tiled.scatter = ScatterRatio::new(scatters(&tiled.whole_tiles()));
        Ok(tiled)
    }

    /// The image with a background of unknown colours; two colours that differ by less than `widths` are one.
    pub(crate) fn with_unmapped_colors(mut self, widths: &Vector3<f64>) -> Self {
        self.unmapped = Some(UnmappedColors::new(&self.whole_tiles(), widths));
        self
    }

    /// The colours of what the map does not show, if they are not known.
    pub(crate) fn unmapped_colors(&self) -> Option<&UnmappedColors> {
        self.unmapped.as_ref()
    }

    /// All pixels of each tile.
    fn whole_tiles(&self) -> Vec<PixelSums> {
        let mut all = TileSums::new(self, 1);
        for row in 0..self.n_rows() {
            all.add_run(self, (row, 0, self.pixels.width()), 0);
        }
        all.add_covered_rows(self);
        all.regions().map(|region| region.sums).collect()
    }

    /// Log-likelihood ratio of the scatter within a region, a pixel: of one surface against any tile of the image. Half of the tiles have the median or less and show one
    /// surface; so no region gains more than a factor of 2.
    pub(crate) fn log_ratio_of_scatter(&self, scatter: &Vector3<f64>) -> f64 {
        let ScatterRatio { at_zero, slope } = &self.scatter;
        -(0.5 + 0.5 * (at_zero + slope.dot(scatter)).exp()).ln()
    }

    /// Number of tiles.
    pub fn n_tiles(&self) -> usize {
        self.columns * self.n_rows().div_ceil(self.side)
    }

    /// Number of pixels of a tile: fewer at the right and the lower border.
    pub(crate) fn n_pixels(&self, tile: usize) -> usize {
        let side = |at: usize, size: usize| self.side.min(size.saturating_sub(at * self.side));
        side(tile % self.columns, self.pixels.width()) * side(tile / self.columns, self.n_rows())
    }

    fn n_rows(&self) -> usize {
        self.pixels.height()
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

impl TileSums {
    /// Empty sums for images of this size.
    pub fn new(image: &TiledImage, n_colors: usize) -> Self {
        let TiledImage { side, columns, .. } = *image;
        let n_colors = n_colors.max(1);
        let n = image.n_tiles() * n_colors;
        let reached = vec![0; n.div_ceil(u64::BITS as usize)];
        Self { side, columns, n_colors, sums: vec![([0; LANES], 0); n], reached }
    }

    /// Number of tiles.
    pub fn n_tiles(&self) -> usize {
        self.sums.len() / self.n_colors
    }

    /// Removes all pixels.
    pub fn clear(&mut self) {
        bits(&self.reached).for_each(|at| self.sums[at] = ([0; LANES], 0));
        self.reached.fill(0);
    }

    /// Adds pixels `start..end` of `row` to a colour, each to its tile; what is outside of the image adds nothing. Rows of a tile that are covered from side to side are
    /// added later, by [`add_covered_rows`](Self::add_covered_rows).
    #[inline]
    pub fn add_run(&mut self, image: &TiledImage, (row, start, end): (usize, usize, usize), color: usize) {
        let prefix = image.pixels.prefix_sums(row);
        if start >= end || end >= prefix.len() || color >= self.n_colors {
            return;
        }
        let first = row / self.side * self.columns;
        let covered = 1 << (row % self.side);
        for column in start / self.side..=(end - 1) / self.side {
            let at = (first + column) * self.n_colors + color;
            let Some((sums, rows)) = self.sums.get_mut(at) else { return };
            self.reached[at / u64::BITS as usize] |= 1 << (at % u64::BITS as usize);
            let (left, right) = (column * self.side, ((column + 1) * self.side).min(prefix.len() - 1));
            if start <= left && right <= end {
                *rows |= covered;
            } else {
                add(sums, &prefix[right.min(end)], &prefix[left.max(start)]);
            }
        }
    }

    /// Adds the rows that runs covered.
    pub fn add_covered_rows(&mut self, image: &TiledImage) {
        for at in bits(&self.reached) {
            let (sums, rows) = &mut self.sums[at];
            let tile = at / self.n_colors;
            let top = tile / self.columns * self.side;
            let down = &image.down[tile % self.columns * (image.n_rows() + 1) + top..];
            while *rows != 0 {
                let start = rows.trailing_zeros();
                let end = start + (*rows >> start).trailing_ones();
                add(sums, &down[end as usize], &down[start as usize]);
                *rows &= u64::MAX << end;
            }
        }
    }

    /// The regions that are not empty, tile by tile.
    pub fn regions(&self) -> impl Iterator<Item = TileRegion> + Clone {
        let region = |at: usize| {
            let sums = PixelSums { lanes: self.sums[at].0.map(u64::from) };
            TileRegion { tile: at / self.n_colors, color: at % self.n_colors, sums }
        };
        bits(&self.reached).map(region).filter(|region| region.sums.count() > 0)
    }
}
