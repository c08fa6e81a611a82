use nalgebra::Vector3;
use wayfix_color_map::ColorId;

use super::NO_COLOR;
use crate::{BackgroundColorModel, ColorDensity, ColorModelError, PixelSumDensity, YuvImage};

/// The most probable map colour of a pixel, $`\arg\max_m p(c | m)`$ under [Schulz & Fox 2004, Eq. 9], all colours being equally frequent.
///
/// ```
/// use nalgebra::{Matrix3, Vector3};
/// use wayfix_color_map::ColorId;
/// use wayfix_color_model::{BackgroundColorModel, PixelClassifier, ColorDensity};
/// let density = |mean| ColorDensity { mean, covariance: Matrix3::identity() * 60.0 };
/// let (green, pink) = (Vector3::new(80.0, 110.0, 100.0), Vector3::new(140.0, 125.0, 180.0));
/// let classifier = PixelClassifier::new([density(green), density(pink)])?.with_background(BackgroundColorModel::Uniform);
/// assert_eq!(classifier.classify([138, 126, 175]), Some(ColorId(1)));
/// assert_eq!(classifier.classify([20, 200, 60]), None); // far from both: the uniform background explains it better
/// # Ok::<(), wayfix_color_model::ColorModelError>(())
/// ```
#[derive(Clone, Debug)]
pub struct PixelClassifier {
    densities: Vec<PixelSumDensity>,
    background: Option<BackgroundColorModel>,
    /// Log ratio of the background's frequency to that of any one colour, nats.
    background_odds: f64,
}

impl PixelClassifier {
    /// Classifies pixels by these densities. The densities of a light are [`LightingFilter::colors`](crate::LightingFilter::colors);
    /// those of uneven light on a field are [`PixelLikelihoodParams::shaded`](crate::PixelLikelihoodParams::shaded).
    /// # Errors
    /// Returns an error if a density has no peak, or there are more than 255.
    pub fn new(densities: impl IntoIterator<Item = ColorDensity>) -> Result<Self, ColorModelError> {
        let densities: Vec<PixelSumDensity> =
            densities.into_iter().map(|density| PixelSumDensity::new(&density)).collect::<Result<_, _>>()?;
        let (expected, got) = (usize::from(NO_COLOR), densities.len());
        if got > expected {
            return Err(ColorModelError::Dimension { what: "colours to tell apart", expected, got });
        }
        Ok(Self { densities, background: None, background_odds: 0.0 })
    }

    /// The same, with a class for whatever the background explains better than any map colour. It is as frequent as each of the colours.
    #[must_use]
    pub fn with_background(self, background: BackgroundColorModel) -> Self {
        Self { background: Some(background), background_odds: 0.0, ..self }
    }

    /// The same with a background that takes this share of all pixels; the colours share the rest evenly.
    ///
    /// # Errors
    /// Returns an error if the share is not between 0 and 1.
    pub fn with_background_share(
        self,
        background: BackgroundColorModel,
        share: f64,
    ) -> Result<Self, ColorModelError> {
        if !(share > 0.0 && share < 1.0) {
            return Err(ColorModelError::OutOfRange { what: "share of the background", value: share });
        }
        let of_a_color = (1.0 - share) / self.densities.len().max(1) as f64;
        Ok(Self { background: Some(background), background_odds: (share / of_a_color).ln(), ..self })
    }

    /// The colour of a pixel; `None` for background. Of equally probable colours the first.
    pub fn classify(&self, pixel: [u8; 3]) -> Option<ColorId> {
        most_probable(&self.densities, pixel, self.floor(pixel))
    }

    /// The colour of a pixel as a number; 255 where the background, of this log-density, does better.
    pub(crate) fn classify_above(&self, pixel: [u8; 3], background: f64) -> u8 {
        most_probable(&self.densities, pixel, background).map_or(NO_COLOR, |color| color.0)
    }

    /// The colour of every pixel: [`ColorId`] as a number, 255 for background.
    pub fn classify_image(&self, image: &YuvImage) -> Vec<u8> {
        let label = |pixel: &[u8; 3]| self.classify(*pixel).map_or(NO_COLOR, |color| color.0);
        image.pixels().iter().map(label).collect()
    }

    /// Labels a row of colours with the same Y and U, V being `first + k · step`.
    ///
    /// Along such a row each log density is a parabola, so it takes three evaluations a row and then two multiplications a colour.
    pub(super) fn label_row(&self, [y, u]: [f64; 2], [first, step]: [f64; 2], row: &mut Row) {
        let at = |k: f64| Vector3::new(y, u, first + k * step);
        for (k, (best, label)) in row.best.iter_mut().zip(&mut row.labels).enumerate() {
            let pixel = at(k as f64).map(|channel| channel as u8);
            (*best, *label) = (self.floor(pixel.into()), NO_COLOR);
        }
        let end = row.best.len() as f64;
        for (color, density) in (0..).zip(&self.densities) {
            let [start, half, full] = [0.0, 0.5 * end, end].map(|k| density.log_at(&at(k)));
            let slope = (4.0 * half - 3.0 * start - full) / end;
            let bend = 2.0 * (full + start - 2.0 * half) / (end * end);
            for (k, (best, label)) in row.best.iter_mut().zip(&mut row.labels).enumerate() {
                let k = k as f64;
                let log = start + k * (slope + k * bend);
                *label = if log > *best { color } else { *label };
                *best = log.max(*best);
            }
        }
    }

    /// Log-density that a colour must exceed.
    fn floor(&self, pixel: [u8; 3]) -> f64 {
        let background = self.background.as_ref();
        background.map_or(f64::NEG_INFINITY, |bg| bg.log_density(pixel) + self.background_odds)
    }
}

/// The colour with the highest log-density for a pixel, the first of equal ones; `None` if none exceeds `floor`.
fn most_probable(densities: &[PixelSumDensity], pixel: [u8; 3], floor: f64) -> Option<ColorId> {
    let better = |best: (Option<ColorId>, f64), (at, density): (u8, &PixelSumDensity)| {
        let log = density.log(pixel);
        if log > best.1 { (Some(ColorId(at)), log) } else { best }
    };
    (0..).zip(densities).fold((None, floor), better).0
}

/// A row of a table while it is compiled: the labels, and how probable they are.
#[derive(Clone, Debug)]
pub(super) struct Row {
    pub(super) labels: Vec<u8>,
    best: Vec<f64>,
}

impl Row {
    pub(super) fn new(len: usize) -> Self {
        Self { labels: vec![NO_COLOR; len], best: vec![0.0; len] }
    }
}
