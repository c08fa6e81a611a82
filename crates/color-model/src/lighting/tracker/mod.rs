//! Tracking of switched lights with known poses: one interface for several filters, so that they can be compared on the same images.

mod interacting;
mod jump_markov;
mod models;
mod single;
mod sun_and_shade;

pub use interacting::{Gpb2LightingTracker, ImmLightingTracker};
pub use jump_markov::JumpMarkovLightingTracker;
pub use sun_and_shade::SunAndShade;

use nalgebra::{DMatrix, DVector};

use super::{ColorDensity, ColorMeans, LightingFilterParams};
use crate::ColorModelError;

/// Tracks the light from the colour means of successive images; poses, and hence labels, are known.
/// | tracker | state | cost of an image |
/// | --- | --- | --- |
/// | [`LightingFilter`](super::LightingFilter) | one Gaussian for all lights | one update |
/// | [`JumpMarkovLightingTracker`] | a Gaussian for each light of the bank; one that comes back is known already | histories × members |
/// | [`ImmLightingTracker`] | one Gaussian a model, mixed: a switch starts from that light's prior again | members + 1 |
/// | [`Gpb2LightingTracker`] | the same, mixed one image later | (members + 1)² |
///
/// **Laws**: a call that fails changes nothing; without images [`colors`](Self::colors) never become more certain.
/// ```
/// # use nalgebra::{DMatrix, DVector, Vector3};
/// # use wayfix_color_model::{ColorModelError, LightingFilter, LightingFilterParams, LightingTracker};
/// # use wayfix_gaussian_core::Gaussian;
/// # let prior = Gaussian::new(DVector::from_vec(vec![100.0, 128.0, 128.0]), DMatrix::identity(3, 3) * 400.0)?;
/// fn keeps_laws(light: &mut impl LightingTracker) -> Result<bool, ColorModelError> {
///     let before = light.colors()?;
///     let is_unchanged = light.predict(-1.0).is_err() && light.colors()? == before;
///     light.predict(1.0)?;
///     Ok(is_unchanged && light.colors()?[0].covariance[(0, 0)] >= before[0].covariance[(0, 0)])
/// }
/// assert!(keeps_laws(&mut LightingFilter::new(prior, LightingFilterParams::default())?)?);
/// # Ok::<(), ColorModelError>(())
/// ```
pub trait LightingTracker {
    /// Lets `seconds` pass.
    ///
    /// # Errors
    /// Returns an error if the time is negative or not finite.
    fn predict(&mut self, seconds: f64) -> Result<(), ColorModelError>;

    /// Updates the light with an image. An image without map colours has no effect.
    /// # Errors
    /// Returns an error if there are more or fewer colours, or a mean is not finite.
    fn update(&mut self, means: &ColorMeans) -> Result<(), ColorModelError>;

    /// Current distributions of the pixels of each colour, in map order. [Schulz & Fox 2004, Eq. 9]
    /// # Errors
    /// Returns an error if the belief has no mean any more.
    fn colors(&self) -> Result<Vec<ColorDensity>, ColorModelError>;

    /// Number of lights that the next image may have been taken in. A switching tracker has one for each member of its bank.
    fn n_lights(&self) -> usize {
        1
    }

    /// Probability that the next image is taken in this light.
    fn light_probability(&self, _light: usize) -> f64 {
        1.0
    }

    /// [`colors`](Self::colors) if the next image is taken in this light.
    ///
    /// # Errors
    /// As for [`colors`](Self::colors).
    fn colors_in(&self, _light: usize) -> Result<Vec<ColorDensity>, ColorModelError> {
        self.colors()
    }

    /// Joint belief about the means of all colours in this light, $`N(μ, Σ)`$. `None` if the tracker has no correlations between colours; every
    /// pixel then counts the uncertainty of its colour.
    fn joint_belief(&self, _light: usize) -> Option<(&DVector<f64>, &DMatrix<f64>)> {
        None
    }

    /// [`update`](Self::update) with an image taken in this light.
    ///
    /// # Errors
    /// As for [`update`](Self::update). A tracker of several lights returns an error if there is no such light.
    fn update_in(&mut self, _light: usize, means: &ColorMeans) -> Result<(), ColorModelError> {
        self.update(means)
    }

    /// The light in which a part of an image may be if the rest is in this one, as where a roof keeps the sun from a part of the floor.
    fn shade_of(&self, _light: usize) -> Option<usize> {
        None
    }

    /// Noise of pixels and of means.
    fn noise(&self) -> LightingFilterParams {
        LightingFilterParams::default()
    }
}
