use nalgebra::{Matrix3, Vector3};
use wayfix_color_model::{ColorDensity, PixelSums};

/// Width of a cell of the UV histogram, levels.
const CELL: usize = 8;
const CELLS: usize = 256 / CELL;
/// The first guess of the cluster reaches this far from the fullest cell's middle, levels.
const REACH: f64 = 16.0;
/// 99 % of a Gaussian in three dimensions lie within this squared Mahalanobis distance (chi-squared quantile).
const GATE: f64 = 11.345;
/// Rounds of gating.
const ROUNDS: usize = 5;
/// Minimum number of carpet pixels.
const MIN_PIXELS: u64 = 1000;

/// The dominant colour of an image's ground.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct Carpet {
    /// Of the pixels that belong to it.
    pub(super) density: ColorDensity,
    pub(super) n_pixels: u64,
    gate: ColorDensity,
    information: Matrix3<f64>,
}

impl Carpet {
    /// The dominant cluster of `pixels` (Y, U, V); `None` when too few belong together.
    pub(super) fn find(pixels: &[[u8; 3]]) -> Option<Self> {
        let middle = fullest_cell(pixels)?;
        let near = |pixel: &&[u8; 3]| {
            (f64::from(pixel[1]) - middle.0).abs() < REACH && (f64::from(pixel[2]) - middle.1).abs() < REACH
        };
        let mut gate = density(pixels.iter().filter(near))?.0;
        for round in 1.. {
            let information = gate.covariance.cholesky()?.inverse();
            let inside = |pixel: &&[u8; 3]| squared_distance(pixel, &gate.mean, &information) < GATE;
            let (next, n_pixels) = density(pixels.iter().filter(inside))?;
            if round == ROUNDS {
                return (n_pixels >= MIN_PIXELS).then_some(Self {
                    density: next,
                    n_pixels,
                    gate,
                    information,
                });
            }
            gate = next;
        }
        None
    }

    /// Whether a pixel belongs to the cluster.
    pub(super) fn contains(&self, pixel: [u8; 3]) -> bool {
        squared_distance(&pixel, &self.gate.mean, &self.information) < GATE
    }
}

/// The middle (U, V) of the cell with most pixels.
fn fullest_cell(pixels: &[[u8; 3]]) -> Option<(f64, f64)> {
    let mut counts = vec![0_u32; CELLS * CELLS];
    for [_, u, v] in pixels {
        counts[usize::from(*u) / CELL * CELLS + usize::from(*v) / CELL] += 1;
    }
    let fullest = counts.iter().enumerate().max_by_key(|(_, count)| **count)?.0;
    let middle = |cell: usize| (cell * CELL + CELL / 2) as f64;
    Some((middle(fullest / CELLS), middle(fullest % CELLS)))
}

/// The Gaussian of pixels; `None` of fewer than four.
pub(super) fn density<'a>(pixels: impl Iterator<Item = &'a [u8; 3]>) -> Option<(ColorDensity, u64)> {
    let mut sums = PixelSums::default();
    pixels.for_each(|pixel| sums.add_pixel(*pixel));
    if sums.count() < 4 {
        return None;
    }
    let mean = sums.mean()?;
    // The variance of rounding to whole levels; it keeps the variance of a saturated channel positive.
    let rounding = Matrix3::from_diagonal_element(1.0 / 12.0);
    let covariance = sums.scatter_about(&mean) / (sums.count() - 1) as f64 + rounding;
    Some((ColorDensity { mean, covariance }, sums.count()))
}

fn squared_distance(pixel: &[u8; 3], mean: &Vector3<f64>, information: &Matrix3<f64>) -> f64 {
    let deviation = Vector3::from(pixel.map(f64::from)) - mean;
    deviation.dot(&(information * deviation))
}

#[cfg(test)]
mod tests {
    use super::*;

    /// A square of green around (100, 110, 100), some white and one ball.
    #[test]
    fn lines_and_balls_are_not_carpet() {
        let mut pixels: Vec<[u8; 3]> = (0..4000_u32)
            .map(|k| [95 + (k % 11) as u8, 108 + (k / 11 % 5) as u8, 98 + (k / 55 % 5) as u8])
            .collect();
        pixels.extend([[220, 128, 128]; 900]);
        pixels.extend([[180, 70, 140]; 300]);
        let carpet = Carpet::find(&pixels).unwrap();
        assert_eq!(carpet.n_pixels, 4000);
        assert!(carpet.contains([100, 110, 100]) && !carpet.contains([220, 128, 128]));
        // The means of 0 to 10 and 0 to 4.
        assert!(
            (carpet.density.mean - Vector3::new(100.0, 110.0, 100.0)).amax() < 0.05,
            "{}",
            carpet.density.mean
        );
    }

    #[test]
    fn a_few_pixels_are_no_carpet() {
        assert_eq!(Carpet::find(&[]), None);
        assert_eq!(Carpet::find(&[[9, 9, 9]; 3]), None);
        assert_eq!(Carpet::find(&[[9, 9, 9]; 999]), None);
        assert!(Carpet::find(&[[9, 9, 9]; 1000]).is_some());
    }
}
