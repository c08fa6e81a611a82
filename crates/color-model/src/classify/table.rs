use wayfix_color_map::ColorId;

use super::Classifier;
use crate::{Background, ColorDensity, ColorModelError, LightingFilter, YuvImage};

/// A [`Classifier`] compiled into a table over YUV, made anew when the light has moved: one look-up a pixel. [Schulz & Fox 2004, VI]
///
/// Six bits of each channel are looked at, so a cell is 4 × 4 × 4 values wide, well below the spread of any colour; 256 kB fit the second cache.
///
/// ```
/// use nalgebra::{DMatrix, DVector};
/// use wayfix_color_map::ColorId;
/// use wayfix_color_model::{LightingFilter, LightingParams, LookUpTable};
/// use wayfix_gaussian_core::Gaussian;
/// let means = DVector::from_vec(vec![80.0, 110.0, 100.0, 140.0, 125.0, 180.0]);
/// let light = LightingFilter::new(Gaussian::new(means, DMatrix::identity(6, 6) * 9.0)?, LightingParams::default())?;
/// let mut table = LookUpTable::new(&light, None)?;
/// assert_eq!(table.classify([138, 126, 175]), Some(ColorId(1)));
/// assert!(!table.follow(&light)?); // the light is the same: nothing to do
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
#[derive(Clone, Debug)]
pub struct LookUpTable {
    cells: Vec<u8>,
    compiled_for: Vec<ColorDensity>,
    background: Option<Background>,
    /// The table is made anew when any colour's density has moved by more than this from the one it was compiled for: symmetrized
    /// Kullback-Leibler divergence, nats. Default 0.05: a shift by about a quarter of a standard deviation.
    pub rebuild_above: f64,
}

const BITS: u32 = 6;
const NONE: u8 = u8::MAX;

impl LookUpTable {
    /// A table for the light that a filter knows, with a class for the background if there is one.
    ///
    /// # Errors
    /// When a colour's density has no peak.
    pub fn new(light: &LightingFilter, background: Option<Background>) -> Result<Self, ColorModelError> {
        let mut table =
            Self { cells: Vec::new(), compiled_for: Vec::new(), background, rebuild_above: 0.05 };
        table.compile(light)?;
        Ok(table)
    }

    /// Makes the table anew if the light has moved; tells whether it has.
    ///
    /// # Errors
    /// When a colour's density has no peak; the table is unchanged then.
    pub fn follow(&mut self, light: &LightingFilter) -> Result<bool, ColorModelError> {
        let moved = light.n_colors() != self.compiled_for.len()
            || light.colors().zip(&self.compiled_for).any(|(now, then)| {
                // A divergence that is not a number is no reason to trust the table.
                divergence(&now, then).is_none_or(|divergence| divergence > self.rebuild_above)
            });
        if moved {
            self.compile(light)?;
        }
        Ok(moved)
    }

    /// The colour of a pixel; `None` for background.
    pub fn classify(&self, pixel: [u8; 3]) -> Option<ColorId> {
        let label = self.cells[cell(pixel)];
        (label != NONE).then_some(ColorId(label))
    }

    /// The colour of every pixel: [`ColorId`] as a number, 255 for background.
    pub fn classify_image(&self, image: &YuvImage) -> Vec<u8> {
        image.pixels().iter().map(|pixel| self.cells[cell(*pixel)]).collect()
    }

    fn compile(&mut self, light: &LightingFilter) -> Result<(), ColorModelError> {
        let mut classifier = Classifier::of_light(light)?;
        if let Some(background) = &self.background {
            classifier = classifier.with_background(background.clone());
        }
        let centre = |bits: usize| ((bits << (8 - BITS)) | (1 << (7 - BITS))) as u8;
        let mask = (1 << BITS) - 1;
        let label = |at: usize| {
            let pixel = [centre(at >> (2 * BITS)), centre((at >> BITS) & mask), centre(at & mask)];
            classifier.classify(pixel).map_or(NONE, |color| color.0)
        };
        self.cells = (0..1 << (3 * BITS)).map(label).collect();
        self.compiled_for = light.colors().collect();
        Ok(())
    }
}

#[inline]
fn cell([y, u, v]: [u8; 3]) -> usize {
    let [y, u, v] = [y, u, v].map(|channel| usize::from(channel >> (8 - BITS)));
    (y << (2 * BITS)) | (u << BITS) | v
}

/// Half of $`KL(p ‖ q) + KL(q ‖ p)`$; `None` when a covariance has no inverse.
fn divergence(p: &ColorDensity, q: &ColorDensity) -> Option<f64> {
    let (p_inverse, q_inverse) = (p.covariance.try_inverse()?, q.covariance.try_inverse()?);
    let between = p.mean - q.mean;
    let shape = q_inverse.dot(&p.covariance) + p_inverse.dot(&q.covariance) - 6.0;
    let shift = between.dot(&((p_inverse + q_inverse) * between));
    let divergence = 0.25 * (shape + shift);
    divergence.is_finite().then_some(divergence)
}
