use super::{Panorama, TurnSense};
use crate::AppearanceError;

/// Which ring of a raw omnidirectional image shows what is highest.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize), serde(rename_all = "kebab-case"))]
pub enum RingOrder {
    /// The outermost: a camera that looks up into a mirror.
    OutermostUp,
    /// The innermost: a camera, or a fisheye lens, that looks up.
    InnermostUp,
}

/// Where the ring of a raw omnidirectional image lies, and how it is unwrapped.
///
/// The first column of the panorama looks along the image's x axis, to the right of the centre; the others follow as `sense` says, as
/// they are seen in the image (a mirror may reverse that in the world).
///
/// ```
/// use wayfix_appearance_cml::{Donut, Panorama, RingOrder, TurnSense};
/// let donut = Donut { center: [4.5, 4.5], radii: [1.0, 4.0], sense: TurnSense::Clockwise, up: RingOrder::OutermostUp };
/// let image = Panorama::from_rgb(10, 10, vec![7; 300])?; // any picture: a buffer of pixels
/// let panorama = donut.unwrap_image(10, 10, image.pixels(), 16, 3)?;
/// assert_eq!((panorama.n_columns(), panorama.n_rows()), (16, 3));
/// assert!(panorama.pixels().iter().all(|pixel| *pixel == [7; 3]));
/// # Ok::<(), wayfix_appearance_cml::AppearanceError>(())
/// ```
#[derive(Clone, Copy, Debug, PartialEq)]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize), serde(deny_unknown_fields))]
pub struct Donut {
    /// Centre of the ring, pixels from the middle of the top left pixel, right and down.
    pub center: [f64; 2],
    /// Inner and outer radius, pixels.
    pub radii: [f64; 2],
    /// Which way the columns follow each other, as seen in the image.
    pub sense: TurnSense,
    /// Which ring becomes the top row.
    pub up: RingOrder,
}

/// Samples across a cell of the panorama, each way: enough where a cell is up to some four pixels wide.
const SAMPLES: usize = 4;

impl Donut {
    /// The ring of an image (pixels row by row) as a panorama of `n_columns` × `n_rows`; each of its cells is the mean of what it covers.
    ///
    /// # Errors
    /// [`AppearanceError::PixelCount`] when the pixels are not `width · height` or the panorama has none, [`AppearanceError::Donut`] when radii
    /// or centre are not finite, not 0 ≤ inner < outer, or the ring does not lie inside the image.
    pub fn unwrap_image(
        &self,
        width: usize,
        height: usize,
        pixels: &[[u8; 3]],
        n_columns: usize,
        n_rows: usize,
    ) -> Result<Panorama, AppearanceError> {
        if width.checked_mul(height) != Some(pixels.len()) || pixels.is_empty() {
            return Err(AppearanceError::PixelCount {
                size: (width, height),
                n_bytes: pixels.len().saturating_mul(3),
            });
        }
        if n_columns == 0 || n_rows == 0 {
            return Err(AppearanceError::PixelCount { size: (n_columns, n_rows), n_bytes: 0 });
        }
        self.check(width, height)?;
        let cell = |cell: usize| self.cell(width, pixels, n_columns, n_rows, cell);
        Ok(Panorama::from_pixels(n_columns, (0..n_columns * n_rows).map(cell).collect()))
    }

    fn check(&self, width: usize, height: usize) -> Result<(), AppearanceError> {
        let [inner, outer] = self.radii;
        let inside =
            |center: f64, extent: usize| center - outer >= -0.5 && center + outer <= extent as f64 - 0.5;
        let is_ring = inner >= 0.0 && inner < outer;
        if is_ring && inside(self.center[0], width) && inside(self.center[1], height) {
            return Ok(());
        }
        Err(AppearanceError::Donut { center: self.center, radii: self.radii, image: (width, height) })
    }

    fn cell(
        &self,
        width: usize,
        pixels: &[[u8; 3]],
        n_columns: usize,
        n_rows: usize,
        cell: usize,
    ) -> [u8; 3] {
        let (row, column) = (cell / n_columns, cell % n_columns);
        let middle = |index: usize, sample: usize| index as f64 + (sample as f64 + 0.5) / SAMPLES as f64;
        let mut sum = [0_u32; 3];
        for sample in 0..SAMPLES * SAMPLES {
            let depth = middle(row, sample / SAMPLES) / n_rows as f64;
            // The first column is centred on the x axis.
            let turn = (middle(column, sample % SAMPLES) - 0.5) / n_columns as f64;
            let pixel = pixels[self.place(depth, turn, width, pixels.len() / width)];
            (0..3).for_each(|channel| sum[channel] += u32::from(pixel[channel]));
        }
        let n = (SAMPLES * SAMPLES) as u32;
        sum.map(|sum| ((sum + n / 2) / n) as u8)
    }

    /// The pixel at a share of the way from the top to the bottom of the panorama, and of a turn.
    fn place(&self, depth: f64, turn: f64, width: usize, height: usize) -> usize {
        let [inner, outer] = self.radii;
        let radius = match self.up {
            RingOrder::OutermostUp => outer + (inner - outer) * depth,
            RingOrder::InnermostUp => inner + (outer - inner) * depth,
        };
        // Rows go down: what looks clockwise in the image is a growing angle there.
        let sign = if self.sense == TurnSense::Clockwise { 1.0 } else { -1.0 };
        let (sin, cos) = (sign * turn * std::f64::consts::TAU).sin_cos();
        let pixel = |center: f64, offset: f64, extent: usize| {
            ((center + offset).round().max(0.0) as usize).min(extent - 1)
        };
        pixel(self.center[1], radius * sin, height) * width + pixel(self.center[0], radius * cos, width)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

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

    fn donut(sense: TurnSense, up: RingOrder) -> Donut {
        Donut { center: [50.0, 50.0], radii: [10.0, 50.0], sense, up }
    }

    #[test]
    fn columns_follow_the_azimuth_and_rows_the_radius() {
        let clockwise = donut(TurnSense::Clockwise, RingOrder::OutermostUp);
        let panorama = clockwise.unwrap_image(SIZE, SIZE, &image(), 8, 2).unwrap();
        let row = |row| panorama.row(row).copied().collect::<Vec<_>>();
        for column in 1..8 {
            let turn = i32::from(row(0)[column][1]);
            assert!((turn - 255 * column as i32 / 8).abs() <= 3, "an eighth of a turn is 32: {turn}");
        }
        assert!(row(0).iter().all(|pixel| pixel[0] > 250) && row(1).iter().all(|pixel| pixel[0] < 5));

        let reversed = donut(TurnSense::Counterclockwise, RingOrder::InnermostUp);
        let reversed = reversed.unwrap_image(SIZE, SIZE, &image(), 8, 2).unwrap();
        assert!(reversed.row(0).all(|pixel| pixel[0] < 5));
        let (there, back) = (row(0)[2], reversed.row(1).nth(6).copied().unwrap());
        assert!(there[1].abs_diff(back[1]) <= 3, "{there:?} {back:?}");
    }

    #[test]
    fn rings_that_are_none_or_reach_beyond_the_image_are_refused() {
        let good = donut(TurnSense::Clockwise, RingOrder::OutermostUp);
        for bad in [
            Donut { radii: [10.0, 51.0], ..good },
            Donut { radii: [10.0, 10.0], ..good },
            Donut { radii: [-1.0, 10.0], ..good },
            Donut { radii: [f64::NAN, 10.0], ..good },
            Donut { radii: [1.0, f64::INFINITY], ..good },
            Donut { center: [f64::NAN, 50.0], ..good },
        ] {
            let refused = bad.unwrap_image(SIZE, SIZE, &image(), 8, 2);
            assert!(matches!(refused, Err(AppearanceError::Donut { .. })), "{bad:?}");
        }
        assert!(good.unwrap_image(SIZE, SIZE, &image()[1..], 8, 2).is_err());
        assert!(good.unwrap_image(0, 0, &[], 8, 2).is_err());
        assert!(good.unwrap_image(SIZE, SIZE, &image(), 0, 2).is_err());
    }
}
