use wayfix_color_map::ColorId;

use crate::{Background, ColorDensity, ColorModelError, LightingFilter, SumDensity};

/// The most probable map colour of a pixel, $`\arg\max_m p(c | m)`$ under Eq. 9 of [Schulz & Fox 2004], all colours being equally frequent.
///
/// ```
/// use nalgebra::{Matrix3, Vector3};
/// use wayfix_color_map::ColorId;
/// use wayfix_color_model::{Background, Classifier, ColorDensity};
/// let density = |mean| ColorDensity { mean, covariance: Matrix3::identity() * 60.0 };
/// let (green, pink) = (Vector3::new(80.0, 110.0, 100.0), Vector3::new(140.0, 125.0, 180.0));
/// let classifier = Classifier::new([density(green), density(pink)])?.with_background(Background::Uniform);
/// assert_eq!(classifier.classify([138, 126, 175]), Some(ColorId(1)));
/// assert_eq!(classifier.classify([20, 200, 60]), None); // far from both: the uniform background explains it better
/// # Ok::<(), wayfix_color_model::ColorModelError>(())
/// ```
#[derive(Clone, Debug)]
pub struct Classifier {
    densities: Vec<SumDensity>,
    background: Option<Background>,
}

impl Classifier {
    /// Tells colours with these densities apart; every pixel is one of them.
    ///
    /// # Errors
    /// When a density has no peak.
    pub fn new(densities: impl IntoIterator<Item = ColorDensity>) -> Result<Self, ColorModelError> {
        let densities = densities.into_iter().map(|density| SumDensity::new(&density)).collect::<Result<_, _>>()?;
        Ok(Self { densities, background: None })
    }

    /// Tells the map's colours apart in the light that a filter knows.
    ///
    /// # Errors
    /// When a density has no peak.
    pub fn of_light(light: &LightingFilter) -> Result<Self, ColorModelError> {
        Self::new(light.colors())
    }

    /// The same, with a class for whatever the background explains better than any map colour.
    #[must_use]
    pub fn with_background(self, background: Background) -> Self {
        Self { background: Some(background), ..self }
    }

    /// The colour of a pixel; `None` for background.
    pub fn classify(&self, pixel: [u8; 3]) -> Option<ColorId> {
        let floor = self.background.as_ref().map_or(f64::NEG_INFINITY, |background| background.log_density(pixel));
        let better = |best: (Option<ColorId>, f64), (at, density): (usize, &SumDensity)| {
            let log = density.log(pixel);
            if log > best.1 { (Some(ColorId(at as u8)), log) } else { best }
        };
        self.densities.iter().enumerate().fold((None, floor), better).0
    }
}
