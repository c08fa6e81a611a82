use nalgebra::Vector3;

use super::{
    PixelSums, PrefixSumImage,
    bit_set::BitSet,
    region::{RegionStatistics, WholeTiles},
    sums::{COUNT, LANES},
    unmapped::UnmappedColors,
};
use crate::{ColorModelError, YuvImage};

/// An image as sums, divided into square tiles: sums of any run of pixels, and of any rows of a tile.
/// ```
/// use wayfix_color_model::{TiledImage, YuvImage};
/// let image = YuvImage::new(63, 20, vec![[90, 110, 100]; 63 * 20])?;
/// assert_eq!(TiledImage::new(&image, 16, |_| 0.0)?.n_tiles(), 4 * 2); // the last ones are not full
/// assert_eq!(TiledImage::new(&image, 100, |_| 0.0)?.n_tiles(), 2); // a side is at most 62
/// # Ok::<(), wayfix_color_model::ColorModelError>(())
/// ```
#[derive(Clone, Debug)]
pub struct TiledImage {
    pixels: PrefixSumImage,
    side: usize,
    columns: usize,
    /// Sums of each column of tiles from the first row up to each row.
    down: Vec<[u32; LANES]>,
    whole: WholeTiles,
    /// Unless the background is known.
    unmapped: Option<UnmappedColors>,
}

/// The pixels of one colour in one tile.
/// ```
/// # use wayfix_color_model::{TileRegion, TileSums, TiledImage, YuvImage};
/// let row = YuvImage::new(4, 1, [10, 20, 30, 40].map(|y| [y, 128, 128]).to_vec())?;
/// let image = TiledImage::new(&row, 2, |_| 0.0)?;
/// let mut tiles = TileSums::new(&image, 3);
/// tiles.add_run(&image, (0, 1, 3), 2); // the two pixels in the middle show the third colour
/// let brightness = |region: TileRegion<'_>| (region.tile, region.color, region.sums().sum().x);
/// assert_eq!(tiles.regions().map(brightness).collect::<Vec<_>>(), [(0, 2, 20.0), (1, 2, 30.0)]);
/// # Ok::<(), wayfix_color_model::ColorModelError>(())
/// ```
#[derive(Clone, Copy, Debug)]
pub struct TileRegion<'a> {
    /// Number of the tile, row by row.
    pub tile: usize,
    /// Index of the colour in the map.
    pub color: usize,
    lanes: &'a [u32; LANES],
}

impl TileRegion<'_> {
    /// Number of its pixels.
    #[inline]
    pub(super) fn n_pixels(&self) -> f64 {
        f64::from(self.lanes[COUNT])
    }

    /// Its pixels.
    pub fn sums(&self) -> PixelSums {
        PixelSums { lanes: self.lanes.map(u64::from) }
    }
}

/// Sums of every colour in every tile of an image.
///
/// ```
/// use wayfix_color_model::{TileSums, TiledImage, YuvImage};
/// let image = TiledImage::new(&YuvImage::new(4, 1, vec![[10, 128, 128]; 4])?, 2, |_| 0.0)?;
/// let mut tiles = TileSums::new(&image, 1); // two tiles of 2 pixels a side
/// tiles.add_run(&image, (0, 1, 4), 0);
/// tiles.add_covered_rows(&image);
/// let counts: Vec<u64> = tiles.regions().map(|region| region.sums().count()).collect();
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
    /// Which of the sums a run reached: a view shows few colours in a tile.
    reached: BitSet,
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
        let whole = WholeTiles::default();
        let mut tiled = Self { pixels, side, columns, down, whole, unmapped: None };
        tiled.whole = WholeTiles::new(&tiled.whole_tiles());
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
        all.regions().map(|region| region.sums()).collect()
    }

    /// Number of pixels of a tile: fewer at the right and the lower border.
    pub(crate) fn n_pixels(&self, tile: usize) -> f64 {
        self.whole.n_pixels(tile)
    }

    /// Mean and scatter of a region.
    #[inline]
    pub(crate) fn statistics(&self, region: &TileRegion<'_>) -> RegionStatistics {
        self.whole.statistics(region)
    }

    /// Log-likelihood ratio of the scatter within a region of a tile, a pixel: of one surface against any tile of the image.
    pub(crate) fn log_ratio_of_scatter(&self, tile: usize, region: &RegionStatistics) -> f64 {
        self.whole.log_ratio_of_scatter(tile, region)
    }

    /// Number of tiles.
    pub fn n_tiles(&self) -> usize {
        self.columns * self.n_rows().div_ceil(self.side)
    }

    fn n_rows(&self) -> usize {
        self.pixels.height()
    }
}

impl TileSums {
    /// Empty sums for images of this size.
    pub fn new(image: &TiledImage, n_colors: usize) -> Self {
        let TiledImage { side, columns, .. } = *image;
        let n_colors = n_colors.max(1);
        let n = image.n_tiles() * n_colors;
        let reached = BitSet::below(n);
        Self { side, columns, n_colors, sums: vec![([0; LANES], 0); n], reached }
    }

    /// Number of tiles.
    pub fn n_tiles(&self) -> usize {
        self.sums.len() / self.n_colors
    }

    /// Removes all pixels.
    pub fn clear(&mut self) {
        self.reached.iter().for_each(|at| self.sums[at] = ([0; LANES], 0));
        self.reached.clear();
    }

    /// Adds pixels `start..end` of `row` to a colour, each to its tile; what is outside of the image adds nothing. Rows of a tile that are covered from side to side are
    /// added later, by [`add_covered_rows`](Self::add_covered_rows).
    #[inline]
    pub fn add_run(&mut self, image: &TiledImage, (row, start, end): (usize, usize, usize), color: usize) {
        let prefix = image.pixels.prefix_sums(row);
        if start >= end || end >= prefix.len() || color >= self.n_colors {
            return;
        }
        // Divisions of 32 bits are twice as fast.
        let tile = |pixel: usize| (pixel as u32 / self.side as u32) as usize;
        let (first, last) = (tile(start), tile(end - 1));
        let tile_row = tile(row);
        let covered = 1 << (row - tile_row * self.side);
        for column in first..=last {
            let at = (tile_row * self.columns + column) * self.n_colors + color;
            let Some((sums, rows)) = self.sums.get_mut(at) else { return };
            self.reached.insert(at);
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
        for at in self.reached.iter() {
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
    pub fn regions(&self) -> impl Iterator<Item = TileRegion<'_>> + Clone {
        let n_colors = self.n_colors as u32; // a division of 32 bits is twice as fast
        let region = move |at: usize| TileRegion {
            tile: (at as u32 / n_colors) as usize,
            color: (at as u32 % n_colors) as usize,
            lanes: &self.sums[at].0,
        };
        self.reached.iter().map(region).filter(|region| region.lanes[COUNT] > 0)
    }
}
