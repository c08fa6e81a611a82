use super::{NO_COLOR, PixelClassifier, classifier::Row};
use crate::{BackgroundColorModel, ColorDensity, ColorModelError, YuvImage};
use wayfix_color_map::ColorId;

/// A [`PixelClassifier`] compiled into a table over YUV, rebuilt when the light changes: one look-up per pixel. [Schulz & Fox 2004, VI]
///
/// It uses six bits of Y and all of U and V: paints differ less in chroma than the light varies in brightness, so chroma needs the finer cells. The
/// table has four megabytes; one image accesses a small part of it.
/// ```
/// use nalgebra::{Matrix3, Vector3};
/// use wayfix_color_map::ColorId;
/// use wayfix_color_model::{ColorDensity, ColorLookUpTable};
/// let density = |mean| ColorDensity { mean, covariance: Matrix3::identity() * 60.0 };
/// let light = vec![density(Vector3::new(80.0, 110.0, 100.0)), density(Vector3::new(140.0, 125.0, 180.0))];
/// let mut table = ColorLookUpTable::new(light.clone(), None)?;
/// assert_eq!(table.classify([138, 126, 175]), Some(ColorId(1)));
/// assert!(!table.rebuild_if_changed(light)?); // the light is the same: nothing to do
/// # Ok::<(), wayfix_color_model::ColorModelError>(())
/// ```
#[derive(Clone, Debug)]
pub struct ColorLookUpTable {
    cells: Vec<u8>,
    compiled_for: Vec<ColorDensity>,
    background: Option<BackgroundColorModel>,
    /// The table is rebuilt when the symmetrized Kullback-Leibler divergence of any colour's density from the compiled one exceeds this,
    /// in nats. Default 0.05: a shift by about a quarter of a standard deviation.
    pub rebuild_above: f64,
}

/// Number of bits used of Y, U, V.
const BITS: [u32; 3] = [6, 8, 8];

impl ColorLookUpTable {
    /// A table for colours with these densities, with a class for the background if there is one.
    ///
    /// # Errors
    /// Returns an error if a colour's density has no peak, or there are more than 255 colours.
    pub fn new(
        colors: Vec<ColorDensity>,
        background: Option<BackgroundColorModel>,
    ) -> Result<Self, ColorModelError> {
        let cells = vec![NO_COLOR; 1 << BITS.iter().sum::<u32>()];
        let mut table = Self { cells, compiled_for: Vec::new(), background, rebuild_above: 0.05 };
        table.compile(colors)?;
        Ok(table)
    }

    /// Rebuilds the table if the light has changed; returns whether it has.
    /// # Errors
    /// Returns an error if a colour's density has no peak; the table is unchanged then.
    pub fn rebuild_if_changed(&mut self, colors: Vec<ColorDensity>) -> Result<bool, ColorModelError> {
        let moved = colors.len() != self.compiled_for.len()
            || colors.iter().zip(&self.compiled_for).any(|(now, then)| {
                // Rebuild if the densities cannot be compared.
                !now.divergence(then).is_some_and(|divergence| divergence <= self.rebuild_above)
            });
        if moved {
            self.compile(colors)?;
        }
        Ok(moved)
    }

    /// The colour of a pixel; `None` for background.
    pub fn classify(&self, pixel: [u8; 3]) -> Option<ColorId> {
        let label = self.cells[cell(pixel)];
        (label != NO_COLOR).then_some(ColorId(label))
    }

    /// The colour of every pixel: [`ColorId`] as a number, 255 for background.
    pub fn classify_image(&self, image: &YuvImage) -> Vec<u8> {
        image.pixels().iter().map(|pixel| self.cells[cell(*pixel)]).collect()
    }

    fn compile(&mut self, colors: Vec<ColorDensity>) -> Result<(), ColorModelError> {
        let mut classifier = PixelClassifier::new(colors.iter().copied())?;
        if let Some(background) = &self.background {
            classifier = classifier.with_background(background.clone());
        }
        let [y, u, v] = BITS.map(|bits| f64::from(1_u32 << (8 - bits)));
        let centre = |k: usize, width: f64| (k as f64 + 0.5) * width - 0.5;
        let mut row = Row::new(1 << BITS[2]);
        for (at, cells) in self.cells.chunks_exact_mut(1 << BITS[2]).enumerate() {
            let at = [centre(at >> BITS[1], y), centre(at & ((1 << BITS[1]) - 1), u)];
            classifier.label_row(at, [centre(0, v), v], &mut row);
            cells.copy_from_slice(&row.labels);
        }
        self.compiled_for = colors;
        Ok(())
    }
}

#[inline]
fn cell([y, u, v]: [u8; 3]) -> usize {
    let [y, u, v] = [(y, BITS[0]), (u, BITS[1]), (v, BITS[2])].map(|(c, bits)| usize::from(c >> (8 - bits)));
    (y << (BITS[1] + BITS[2])) | (u << BITS[2]) | v
}
