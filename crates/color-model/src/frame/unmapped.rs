use nalgebra::Vector3;
use wayfix_estimation_traits::LogWeight;

use super::PixelSums;

/// The tiles of an image, sorted by their mean colour: objects outside the map have unknown colours.
///
/// Tiles that show nothing of the map have colours of an unknown distribution over cells $`k`$, $`p ∼ \operatorname{Dir}(q)`$. Its mean $`q`$ is that of all tiles of the
/// image, with the weight of one tile [Perks 1947]. One tile after the other is as probable as its cell among those before:
/// ```math
/// p(n) = \frac{1}{n!} \prod_k \prod_{m = 0}^{n_k - 1} (q_k + m)
/// ```
/// of $`n_k`$ such tiles, $`n`$ in all [Johnson et al. 1997, 35.152]. Between whole numbers $`\ln p`$ is linear. A pose that leaves carpet of the image to an unknown
/// background finds carpet there, and pays for it.
#[derive(Clone, Debug)]
pub(crate) struct UnmappedColors {
    /// Cell of each tile.
    cells: Vec<usize>,
    /// Tiles of each cell.
    counts: Vec<f64>,
    /// $`\ln \prod_m (q_k + m) / q_k`$ of each cell.
    log_products: Vec<RunningSums>,
    /// $`\ln n!`$.
    log_factorials: RunningSums,
    /// Log-likelihood of all tiles.
    all: LogWeight,
}

impl UnmappedColors {
    /// The tiles of an image with cells of these widths.
    pub(crate) fn new(tiles: &[PixelSums], widths: &Vector3<f64>) -> Self {
        let cell = |tile: &PixelSums| {
            let mean = tile.mean().unwrap_or_default();
            [0, 1, 2].map(|at| (mean[at] / widths[at]) as u32)
        };
        let keys: Vec<[u32; 3]> = tiles.iter().map(cell).collect();
        let mut order = keys.clone();
        order.sort_unstable();
        order.dedup();
        let cells: Vec<usize> = keys.iter().map(|key| order.partition_point(|other| other < key)).collect();
        let mut counts = vec![0.0; order.len()];
        cells.iter().for_each(|cell| counts[*cell] += 1.0);
        let log_products = counts.iter().map(|count| {
            let share = count / tiles.len() as f64;
            RunningSums::new(*count as usize, |m| ((share + m) / share).ln())
        });
        let mut colors = Self {
            cells,
            log_products: log_products.collect(),
            log_factorials: RunningSums::new(tiles.len(), |n| (1.0 + n).ln()),
            counts,
            all: 0.0,
        };
        colors.all = colors.log_likelihood(&colors.counts);
        colors
    }

    /// Log-likelihood of what is left to the background, relative to an image that shows nothing of the map. `mapped` has tiles and the share of each that shows the map.
    pub(crate) fn log_ratio(
        &self,
        mapped: impl Iterator<Item = (usize, f64)>,
        counts: &mut Vec<f64>,
    ) -> LogWeight {
        counts.clone_from(&self.counts);
        for (tile, share) in mapped {
            counts[self.cells[tile]] -= share;
        }
        self.log_likelihood(counts) - self.all
    }

    /// $`\ln p(n) - \sum_k n_k \ln q_k`$.
    fn log_likelihood(&self, counts: &[f64]) -> LogWeight {
        let products = counts.iter().zip(&self.log_products).map(|(count, table)| table.at(*count));
        products.sum::<f64>() - self.log_factorials.at(counts.iter().sum())
    }
}

/// Sums of the first 0, 1 … terms, each with what the next term adds: linear in between.
#[derive(Clone, Debug)]
struct RunningSums(Vec<(f64, f64)>);

impl RunningSums {
    fn new(n: usize, term: impl Fn(f64) -> f64) -> Self {
        let mut sums = vec![0.0];
        for at in 0..n {
            sums.push(sums[at] + term(at as f64));
        }
        let next = sums.iter().skip(1).chain(sums.last());
        Self(sums.iter().zip(next).map(|(sum, next)| (*sum, next - sum)).collect())
    }

    #[inline]
    fn at(&self, n: f64) -> f64 {
        let below = (n as usize).min(self.0.len() - 1);
        let (sum, step) = self.0[below];
        sum + (n - below as f64).clamp(0.0, 1.0) * step
    }
}

#[cfg(test)]
mod tests {
    use approx::assert_abs_diff_eq;

    use super::*;

    fn tiles(values: &[u8]) -> Vec<PixelSums> {
        let tile = |value: &u8| {
            let mut sums = PixelSums::default();
            (0..4).for_each(|_| sums.add_pixel([*value, 128, 128]));
            sums
        };
        values.iter().map(tile).collect()
    }

    /// Tile by tile: the share of its cell among those before, with the prior as one tile.
    #[test]
    fn likelihood_is_that_of_one_tile_after_the_other() {
        let values = [20, 20, 20, 90, 90, 200];
        let colors = UnmappedColors::new(&tiles(&values), &Vector3::repeat(10.0));
        let mut expected = 0.0;
        for (n, value) in values.iter().enumerate() {
            let of = |values: &[u8]| values.iter().filter(|other| *other == value).count() as f64;
            let share = of(&values) / values.len() as f64;
            expected += ((share + of(&values[..n])) / (1.0 + n as f64) / share).ln();
        }
        assert_abs_diff_eq!(colors.all, expected, epsilon = 1e-9);
        assert_abs_diff_eq!(colors.log_ratio(std::iter::empty(), &mut Vec::new()), 0.0);
    }

    #[test]
    fn a_background_of_one_colour_is_more_probable_than_one_of_two() {
        let values: Vec<u8> = (0..100).map(|at| if at < 50 { 20 } else { 90 }).collect();
        let colors = UnmappedColors::new(&tiles(&values), &Vector3::repeat(10.0));
        let ratio = |mapped: std::ops::Range<usize>| {
            colors.log_ratio(mapped.map(|tile| (tile, 1.0)), &mut Vec::new())
        };
        let (one, two) = (ratio(0..50), ratio(25..75));
        // Half of the information of 50 tiles of two colours, ln 2 each, with little to learn.
        assert!(one - two > 0.8 * 50.0 * std::f64::consts::LN_2, "{one} {two}");
    }
}
