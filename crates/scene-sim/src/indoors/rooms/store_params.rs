use nalgebra::Vector2;

use super::shelf::SECTION_M;
use crate::{SimulationError, check};

/// Depth of a shelf, which is also the length of its ends, metres.
const DEPTH_M: f64 = 1.0;
/// The longest side of a store, metres.
const LONGEST_M: f64 = 500.0;

/// Size and furnishing of a [`RetailStore`](crate::indoors::RetailStore): shelves in rows along x, cut into blocks by aisles along y.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct RetailStoreParams {
    /// Extent along x, metres.
    pub length_m: f64,
    /// Extent along y, metres.
    pub width_m: f64,
    /// Minimum width of the aisles between the shelves, m; the remaining space is divided equally.
    pub min_aisle_width_m: f64,
    /// The same of the aisles between the blocks, metres.
    pub min_cross_aisle_width_m: f64,
    /// Shelves of a row.
    pub n_blocks: usize,
    /// Height of the shelves, metres.
    pub shelf_height_m: f64,
    /// Number of departments, each with its own colours.
    pub n_departments: usize,
    /// Share of the shelf ends with a stand of special offers.
    pub end_display_share: f64,
}

impl RetailStoreParams {
    /// The home store of 50 m × 80 m. [Gross et al. 2005, Sec. 3]
    pub fn home_store() -> Self {
        Self {
            length_m: 80.0,
            width_m: 50.0,
            min_aisle_width_m: 2.6,
            min_cross_aisle_width_m: 3.0,
            n_blocks: 3,
            shelf_height_m: 2.1,
            n_departments: 8,
            end_display_share: 0.3,
        }
    }

    /// A part of it, 25 m × 10 m. [Gross et al. 2005, Fig. 4]
    pub fn area() -> Self {
        Self { length_m: 25.0, width_m: 10.0, n_blocks: 2, n_departments: 3, ..Self::home_store() }
    }

    /// Whether the numbers make a store with a shelf at least.
    ///
    /// # Errors
    /// Returns an error with the first parameter that is out of range.
    pub fn validate(&self) -> Result<(), SimulationError> {
        check::positive("length of the store (m)", self.length_m)?;
        check::at_most("length of the store (m)", self.length_m, LONGEST_M, "at most 500")?;
        check::positive("width of the store (m)", self.width_m)?;
        check::at_most("width of the store (m)", self.width_m, LONGEST_M, "at most 500")?;
        check::above("width of the aisles (m)", self.min_aisle_width_m, 1.0, "above 1")?;
        check::above("width of the aisles between blocks (m)", self.min_cross_aisle_width_m, 2.0, "above 2")?;
        check::above("blocks", self.n_blocks as f64, 0.5, "at least 1")?;
        check::count("blocks", self.n_blocks, 100)?;
        check::above("height of the shelves (m)", self.shelf_height_m, 0.5, "above 0.5")?;
        check::at_most("height of the shelves (m)", self.shelf_height_m, 4.0, "at most 4")?;
        check::above("departments", self.n_departments as f64, 0.5, "at least 1")?;
        check::count("departments", self.n_departments, 256)?;
        check::share("share of the shelf ends with a stand", self.end_display_share)?;
        check::above(
            "width of the store (m)",
            self.width_m,
            2.0 * self.min_aisle_width_m + DEPTH_M,
            "room for a row of shelves",
        )?;
        let blocks = self.n_blocks as f64;
        let least = blocks * 2.0 * SECTION_M + (blocks + 1.0) * self.min_cross_aisle_width_m;
        check::above("length of the store (m)", self.length_m, least, "room for blocks of 2 m and more")
    }

    pub(in crate::indoors) fn n_rows(&self) -> usize {
        ((self.width_m - self.min_aisle_width_m) / (self.min_aisle_width_m + DEPTH_M)) as usize
    }

    /// Sections of a long side of a shelf.
    pub(in crate::indoors) fn n_sections(&self) -> usize {
        let blocks = self.n_blocks as f64;
        ((self.length_m - (blocks + 1.0) * self.min_cross_aisle_width_m) / (blocks * SECTION_M)) as usize
    }

    /// Lowest and highest corner of a shelf, counted block by block in each row.
    pub(in crate::indoors) fn shelf(&self, number: usize) -> (Vector2<f64>, Vector2<f64>) {
        let (row, block) = (number / self.n_blocks, number % self.n_blocks);
        let size = Vector2::new(self.n_sections() as f64 * SECTION_M, DEPTH_M);
        let gaps = self.gaps();
        let low = Vector2::new(
            -0.5 * self.length_m + gaps.x + block as f64 * (size.x + gaps.x),
            -0.5 * self.width_m + gaps.y + row as f64 * (size.y + gaps.y),
        );
        (low, low + size)
    }

    /// Middle lines of the aisles along y and of those along x.
    pub(in crate::indoors) fn aisles(&self) -> (Vec<f64>, Vec<f64>) {
        let (gaps, shelf_m) = (self.gaps(), self.n_sections() as f64 * SECTION_M);
        let xs =
            (0..=self.n_blocks).map(|i| -0.5 * self.length_m + 0.5 * gaps.x + i as f64 * (shelf_m + gaps.x));
        let ys =
            (0..=self.n_rows()).map(|i| -0.5 * self.width_m + 0.5 * gaps.y + i as f64 * (DEPTH_M + gaps.y));
        (xs.collect(), ys.collect())
    }

    /// True widths of the aisles along y and along x.
    fn gaps(&self) -> Vector2<f64> {
        let (blocks, rows) = (self.n_blocks as f64, self.n_rows() as f64);
        let shelves_m = blocks * self.n_sections() as f64 * SECTION_M;
        Vector2::new(
            (self.length_m - shelves_m) / (blocks + 1.0),
            (self.width_m - rows * DEPTH_M) / (rows + 1.0),
        )
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use approx::assert_abs_diff_eq;

    #[test]
    fn shelves_and_aisles_fill_the_store() {
        for params in [RetailStoreParams::home_store(), RetailStoreParams::area()] {
            params.validate().unwrap();
            let (_, high) = params.shelf(params.n_rows() * params.n_blocks - 1);
            let gaps = params.gaps();
            assert_abs_diff_eq!(high.x + gaps.x, 0.5 * params.length_m, epsilon = 1e-9);
            assert_abs_diff_eq!(high.y + gaps.y, 0.5 * params.width_m, epsilon = 1e-9);
            assert!(gaps.y >= params.min_aisle_width_m && gaps.x >= params.min_cross_aisle_width_m);
        }
    }
}
