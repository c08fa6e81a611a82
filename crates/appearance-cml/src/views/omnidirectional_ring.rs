use std::f64::consts::TAU;

use super::{AzimuthDirection, Panorama};
use crate::AppearanceMapError;

/// Which ring of a raw omnidirectional image shows what is highest.
///
/// ```
/// # use wayfix_appearance_cml::{AppearanceMapError, AzimuthDirection, OmnidirectionalRing, RingVerticalOrientation};
/// let radius = |i: i32| (f64::from(i % 10) - 4.5).hypot(f64::from(i / 10) - 4.5);
/// let image: Vec<[u8; 3]> = (0..100).map(|i| if radius(i) > 2.5 { [255, 0, 0] } else { [0, 0, 255] }).collect();
/// let top = |ring_orientation| -> Result<[u8; 3], AppearanceMapError> {
///     let ring = OmnidirectionalRing { center: [4.5; 2], radii: [1.0, 4.0], azimuth_direction: AzimuthDirection::Clockwise, ring_orientation };
///     Ok(ring.unwrap_image(10, 10, &image, 16, 2)?.pixels()[0])
/// };
/// assert_eq!(top(RingVerticalOrientation::OutermostUp)?, [255, 0, 0]); // the outer half of the ring
/// assert_eq!(top(RingVerticalOrientation::InnermostUp)?, [0, 0, 255]);
/// # Ok::<(), wayfix_appearance_cml::AppearanceMapError>(())
/// ```
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize), serde(rename_all = "kebab-case"))]
pub enum RingVerticalOrientation {
    /// The outermost: a camera below a mirror.
    OutermostUp,
    /// The innermost: a camera or fisheye lens that points up.
    InnermostUp,
}

/// Where the ring of a raw omnidirectional image lies, and how it is unwrapped.
///
/// The first column of the panorama points along the image's x axis, to the right of the centre; the others follow as `azimuth_direction` says, as
/// they are seen in the image (a mirror may reverse that in the world).
///
/// ```
/// use wayfix_appearance_cml::{OmnidirectionalRing, Panorama, RingVerticalOrientation, AzimuthDirection};
/// let donut = OmnidirectionalRing { center: [4.5, 4.5], radii: [1.0, 4.0], azimuth_direction: AzimuthDirection::Clockwise, ring_orientation: RingVerticalOrientation::OutermostUp };
/// let image = Panorama::from_rgb(10, 10, vec![7; 300])?; // any picture: a buffer of pixels
/// let panorama = donut.unwrap_image(10, 10, image.pixels(), 16, 3)?;
/// assert_eq!((panorama.n_columns(), panorama.n_rows()), (16, 3));
/// assert!(panorama.pixels().iter().all(|pixel| *pixel == [7; 3]));
/// # Ok::<(), wayfix_appearance_cml::AppearanceMapError>(())
/// ```
#[derive(Clone, Copy, Debug, PartialEq)]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize), serde(deny_unknown_fields))]
pub struct OmnidirectionalRing {
    /// Centre of the ring, pixels from the middle of the top left pixel, right and down.
    pub center: [f64; 2],
    /// Inner and outer radius, pixels.
    pub radii: [f64; 2],
    /// Which way the columns follow each other, as seen in the image.
    pub azimuth_direction: AzimuthDirection,
    /// Which ring becomes the top row.
    pub ring_orientation: RingVerticalOrientation,
}

impl OmnidirectionalRing {
    /// The ring of an image (pixels row by row) as a panorama of `n_columns` × `n_rows`; each of its cells is the mean of the pixels
    /// whose middles lie in it, whatever its size. A cell without any, which is smaller than a pixel, is the pixel at its middle.
    ///
    /// # Errors
    /// [`AppearanceMapError::PixelCount`] when the pixels are not `width · height` or the panorama has none, [`AppearanceMapError::OmnidirectionalRing`] when radii
    /// or centre are not finite, not 0 ≤ inner < outer, or the ring does not lie inside the image.
    pub fn unwrap_image(
        &self,
        width: usize,
        height: usize,
        pixels: &[[u8; 3]],
        n_columns: usize,
        n_rows: usize,
    ) -> Result<Panorama, AppearanceMapError> {
        if width.checked_mul(height) != Some(pixels.len()) || pixels.is_empty() {
            return Err(AppearanceMapError::PixelCount {
                size: (width, height),
                n_bytes: pixels.len().saturating_mul(3),
            });
        }
        if n_columns == 0 || n_rows == 0 {
            return Err(AppearanceMapError::PixelCount { size: (n_columns, n_rows), n_bytes: 0 });
        }
        self.check(width, height)?;
        let mut sums = vec![Sum::default(); n_columns * n_rows];
        for (index, pixel) in pixels.iter().enumerate() {
            let place = [(index % width) as f64, (index / width) as f64];
            if let Some(cell) = self.cell_of(place, n_columns, n_rows) {
                sums[cell].add(pixel);
            }
        }
        let mean = |(cell, sum): (usize, &Sum)| {
            sum.mean().unwrap_or_else(|| pixels[self.middle(cell, n_columns, n_rows, [width, height])])
        };
        Ok(Panorama::from_pixels(n_columns, sums.iter().enumerate().map(mean).collect()))
    }

    fn check(&self, width: usize, height: usize) -> Result<(), AppearanceMapError> {
        let [inner, outer] = self.radii;
        let inside =
            |center: f64, extent: usize| center - outer >= -0.5 && center + outer <= extent as f64 - 0.5;
        let is_ring = inner >= 0.0 && inner < outer;
        if is_ring && inside(self.center[0], width) && inside(self.center[1], height) {
            return Ok(());
        }
        Err(AppearanceMapError::OmnidirectionalRing {
            center: self.center,
            radii: self.radii,
            image: (width, height),
        })
    }

    /// The cell of the panorama that a pixel lies in, if it lies in the ring.
    fn cell_of(&self, place: [f64; 2], n_columns: usize, n_rows: usize) -> Option<usize> {
        let [inner, outer] = self.radii;
        let [x, y] = [place[0] - self.center[0], place[1] - self.center[1]];
        let radius = x.hypot(y);
        let above = match self.ring_orientation {
            RingVerticalOrientation::OutermostUp => outer - radius,
            RingVerticalOrientation::InnermostUp => radius - inner,
        };
        let row = above / (outer - inner) * n_rows as f64;
        if !(0.0..n_rows as f64).contains(&row) {
            return None;
        }
        // The first column is centred on the x axis.
        let turn = self.sign() * y.atan2(x) / TAU * n_columns as f64 + 0.5;
        let column = (turn.rem_euclid(n_columns as f64) as usize).min(n_columns - 1);
        Some(row as usize * n_columns + column)
    }

    /// The pixel at the middle of a cell.
    fn middle(&self, cell: usize, n_columns: usize, n_rows: usize, [width, height]: [usize; 2]) -> usize {
        let [inner, outer] = self.radii;
        let depth = ((cell / n_columns) as f64 + 0.5) / n_rows as f64;
        let radius = match self.ring_orientation {
            RingVerticalOrientation::OutermostUp => outer + (inner - outer) * depth,
            RingVerticalOrientation::InnermostUp => inner + (outer - inner) * depth,
        };
        let (sin, cos) = (self.sign() * (cell % n_columns) as f64 / n_columns as f64 * TAU).sin_cos();
        let pixel = |center: f64, offset: f64, extent: usize| {
            ((center + offset).round().max(0.0) as usize).min(extent - 1)
        };
        pixel(self.center[1], radius * sin, height) * width + pixel(self.center[0], radius * cos, width)
    }

    /// Rows go down, so angles grow clockwise in the image.
    fn sign(&self) -> f64 {
        if self.azimuth_direction == AzimuthDirection::Clockwise { 1.0 } else { -1.0 }
    }
}

/// Pixels added up.
#[derive(Clone, Copy, Debug, Default)]
struct Sum {
    channels: [u64; 3],
    n: u64,
}

impl Sum {
    fn add(&mut self, pixel: &[u8; 3]) {
        self.n += 1;
        self.channels.iter_mut().zip(pixel).for_each(|(sum, value)| *sum += u64::from(*value));
    }

    /// Rounded to the nearest; `None` without a pixel.
    fn mean(&self) -> Option<[u8; 3]> {
        (self.n > 0).then(|| self.channels.map(|sum| ((sum + self.n / 2) / self.n) as u8))
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use approx::abs_diff_eq;

    const SIZE: usize = 101;

    /// Brightness grows once round, clockwise from the right; the outer half of the ring is red.
    fn image() -> Vec<[u8; 3]> {
        let pixel = |index: usize| {
            let (x, y) = ((index % SIZE) as f64 - 50.0, (index / SIZE) as f64 - 50.0);
            let turn = y.atan2(x).rem_euclid(std::f64::consts::TAU) / std::f64::consts::TAU;
            let red = if x.hypot(y) > 30.0 { 255 } else { 0 };
            [red, (turn * 255.0) as u8, 0]
        };
        (0..SIZE * SIZE).map(pixel).collect()
    }

    fn donut(sense: AzimuthDirection, up: RingVerticalOrientation) -> OmnidirectionalRing {
        OmnidirectionalRing {
            center: [50.0, 50.0],
            radii: [10.0, 50.0],
            azimuth_direction: sense,
            ring_orientation: up,
        }
    }

    #[test]
    fn columns_follow_the_azimuth_and_rows_the_radius() {
        let clockwise = donut(AzimuthDirection::Clockwise, RingVerticalOrientation::OutermostUp);
        let panorama = clockwise.unwrap_image(SIZE, SIZE, &image(), 8, 2).unwrap();
        let row = |row| panorama.row(row).copied().collect::<Vec<_>>();
        for column in 1..8 {
            let turn = i32::from(row(0)[column][1]);
            assert!(
                abs_diff_eq!(turn, 255 * column as i32 / 8, epsilon = 3),
                "an eighth of a turn is 32: {turn}"
            );
        }
        assert!(row(0).iter().all(|pixel| pixel[0] > 250) && row(1).iter().all(|pixel| pixel[0] < 5));

        let reversed = donut(AzimuthDirection::Counterclockwise, RingVerticalOrientation::InnermostUp);
        let reversed = reversed.unwrap_image(SIZE, SIZE, &image(), 8, 2).unwrap();
        assert!(reversed.row(0).all(|pixel| pixel[0] < 5));
        let (there, back) = (row(0)[2], reversed.row(1).nth(6).copied().unwrap());
        assert!(there[1].abs_diff(back[1]) <= 3, "{there:?} {back:?}");
    }

    /// Every pixel of a checkerboard of single pixels counts: a sample of them would see more of one colour, by chance.
    #[test]
    fn a_large_cell_is_the_mean_of_all_its_pixels() {
        let size = 1001;
        let checkered: Vec<[u8; 3]> =
            (0..size * size).map(|i| [if i % 2 == 0 { 40 } else { 200 }; 3]).collect();
        let donut = OmnidirectionalRing {
            center: [500.0; 2],
            radii: [100.0, 490.0],
            ..donut(AzimuthDirection::Clockwise, RingVerticalOrientation::OutermostUp)
        };
        let panorama = donut.unwrap_image(size, size, &checkered, 36, 10).unwrap();
        // at least 700 pixels a cell; those of either colour differ by no more than lie at its border of some 120 pixels
        for pixel in panorama.pixels() {
            assert!(pixel[0].abs_diff(120) <= 14, "{pixel:?}");
        }
        // noise, whose mean over a cell is only found by adding up that cell
        let noise: Vec<[u8; 3]> = (0..size * size).map(|i| [(i * i % 251) as u8; 3]).collect();
        let panorama = donut.unwrap_image(size, size, &noise, 36, 10).unwrap();
        let (mut sum, mut n) = (0.0, 0.0);
        for (i, pixel) in noise.iter().enumerate() {
            let (x, y) = ((i % size) as f64 - 500.0, (i / size) as f64 - 500.0);
            let in_row = (451.0..490.0).contains(&x.hypot(y)); // the topmost of ten rings of 39 pixels
            if in_row && y.atan2(x).abs() < TAU / 72.0 {
                sum += f64::from(pixel[0]);
                n += 1.0;
            }
        }
        assert!(
            abs_diff_eq!(f64::from(panorama.pixels()[0][0]), sum / n, epsilon = 1.0),
            "{:?} {}",
            panorama.pixels()[0],
            sum / n
        );
    }

    #[test]
    fn cells_smaller_than_a_pixel_show_the_pixel_there() {
        let fine = donut(AzimuthDirection::Clockwise, RingVerticalOrientation::OutermostUp)
            .unwrap_image(SIZE, SIZE, &image(), 720, 80)
            .unwrap();
        for column in [90, 180, 450] {
            let turn = i32::from(fine.row(79).nth(column).unwrap()[1]);
            // a pixel at radius 10 is 1/63 of a turn wide: 4 of 255
            assert!(abs_diff_eq!(turn, 255 * column as i32 / 720, epsilon = 4), "{column}: {turn}");
        }
    }

    #[test]
    fn rings_that_are_none_or_reach_beyond_the_image_are_refused() {
        let good = donut(AzimuthDirection::Clockwise, RingVerticalOrientation::OutermostUp);
        for bad in [
            OmnidirectionalRing { radii: [10.0, 51.0], ..good },
            OmnidirectionalRing { radii: [10.0, 10.0], ..good },
            OmnidirectionalRing { radii: [-1.0, 10.0], ..good },
            OmnidirectionalRing { radii: [f64::NAN, 10.0], ..good },
            OmnidirectionalRing { radii: [1.0, f64::INFINITY], ..good },
            OmnidirectionalRing { center: [f64::NAN, 50.0], ..good },
        ] {
            let refused = bad.unwrap_image(SIZE, SIZE, &image(), 8, 2);
            assert!(matches!(refused, Err(AppearanceMapError::OmnidirectionalRing { .. })), "{bad:?}");
        }
        assert!(good.unwrap_image(SIZE, SIZE, &image()[1..], 8, 2).is_err());
        assert!(good.unwrap_image(0, 0, &[], 8, 2).is_err());
        assert!(good.unwrap_image(SIZE, SIZE, &image(), 0, 2).is_err());
    }
}
