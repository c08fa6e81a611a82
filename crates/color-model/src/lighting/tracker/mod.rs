//! Tracking of switched lights with known poses: one interface for several filters, so that they can be compared on the same images.

mod interacting;
mod jump_markov;
mod models;
mod single;

pub use interacting::{Gpb2LightingTracker, ImmLightingTracker};
pub use jump_markov::JumpMarkovLightingTracker;

use super::{ColorDensity, ColorMeans};
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

    /// Current distributions of the pixels of each colour (Eq. 9), in map order.
    /// # Errors
    /// Returns an error if the belief has no mean any more.
    fn colors(&self) -> Result<Vec<ColorDensity>, ColorModelError>;
}
