use nalgebra::{DMatrix, DVector};

use super::LightingTracker;
use crate::{ColorDensity, ColorMeans, ColorModelError, LightingFilterParams};

/// A light, and another one of the same kind that shines on a part of what the camera sees: the sun, and the shade on the same carpet.
///
/// Its lights are those of the sun, then those of the shade in the same order. Both have the same prior; each learns from its own pixels.
/// ```
/// # use nalgebra::{DMatrix, DVector, Vector3};
/// # use wayfix_color_model::{ColorMeans, LightingFilter, LightingFilterParams, LightingTracker, SunAndShade};
/// # use wayfix_gaussian_core::Gaussian;
/// # let prior = Gaussian::new(DVector::from_vec(vec![100.0, 128.0, 128.0]), DMatrix::identity(3, 3) * 400.0)?;
/// let mut light = SunAndShade::new(LightingFilter::new(prior, LightingFilterParams::default())?, true);
/// assert_eq!((light.n_lights(), light.shade_of(0)), (2, Some(1)));
/// assert_eq!(light.light_probability(1), 0.0); // an image is never in the shade as a whole
/// light.update_in(1, &ColorMeans::new([(Some(Vector3::new(60.0, 128.0, 128.0)), 500)]))?;
/// assert!(light.colors_in(1)?[0].mean.x < 70.0);
/// assert_eq!(light.colors_in(0)?[0].mean.x, 100.0); // the sun is as before
/// # Ok::<(), wayfix_color_model::ColorModelError>(())
/// ```
#[derive(Clone, Debug)]
pub struct SunAndShade<T> {
    pub(crate) sun: T,
    /// `None` if all pixels of an image share a light.
    shade: Option<T>,
}

impl<T: LightingTracker + Clone> SunAndShade<T> {
    /// Both begin with this light; there is no shade unless an image `mixes_lights`.
    pub fn new(light: T, mixes_lights: bool) -> Self {
        Self { shade: mixes_lights.then(|| light.clone()), sun: light }
    }

    /// The tracker that has a light, and the index of the light in it.
    fn part(&self, light: usize) -> (&T, usize) {
        match light.checked_sub(self.sun.n_lights()).zip(self.shade.as_ref()) {
            Some((at, shade)) => (shade, at),
            None => (&self.sun, light),
        }
    }
}

impl<T: LightingTracker + Clone> LightingTracker for SunAndShade<T> {
    fn predict(&mut self, seconds: f64) -> Result<(), ColorModelError> {
        self.sun.predict(seconds)?;
        self.shade.iter_mut().try_for_each(|shade| shade.predict(seconds))
    }

    fn update(&mut self, means: &ColorMeans) -> Result<(), ColorModelError> {
        self.sun.update(means)
    }

    fn colors(&self) -> Result<Vec<ColorDensity>, ColorModelError> {
        self.sun.colors()
    }

    fn n_lights(&self) -> usize {
        self.sun.n_lights() * (1 + usize::from(self.shade.is_some()))
    }

    /// 0 for a shade: it never shines alone.
    fn light_probability(&self, light: usize) -> f64 {
        if light < self.sun.n_lights() { self.sun.light_probability(light) } else { 0.0 }
    }

    fn colors_in(&self, light: usize) -> Result<Vec<ColorDensity>, ColorModelError> {
        let (part, at) = self.part(light);
        part.colors_in(at)
    }

    fn joint_belief(&self, light: usize) -> Option<(&DVector<f64>, &DMatrix<f64>)> {
        let (part, at) = self.part(light);
        part.joint_belief(at)
    }

    fn update_in(&mut self, light: usize, means: &ColorMeans) -> Result<(), ColorModelError> {
        let n_lights = self.sun.n_lights();
        match light.checked_sub(n_lights).zip(self.shade.as_mut()) {
            Some((at, shade)) => shade.update_in(at, means),
            None => self.sun.update_in(light, means),
        }
    }

    fn shade_of(&self, light: usize) -> Option<usize> {
        let n_lights = self.sun.n_lights();
        (self.shade.is_some() && light < n_lights).then_some(n_lights + light)
    }

    fn noise(&self) -> LightingFilterParams {
        self.sun.noise()
    }
}
