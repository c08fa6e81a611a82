use wayfix_condensation::{LightChange, RgbImage, shifted};

use super::super::ViewsError;

/// Change of an image into the real scene: other light, then a camera shift in pixels.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct RealSceneTransform {
    /// The light.
    pub light: LightChange,
    /// Shift to the right and down, in pixels.
    pub shift: (i32, i32),
}

impl Default for RealSceneTransform {
    /// Less contrast, more brightness, a nonlinear tone curve, and a camera shift of 4 and 3 pixels.
    fn default() -> Self {
        Self { light: LightChange { gain: 0.7, offset: 20.0, gamma: 1.3 }, shift: (4, 3) }
    }
}

impl RealSceneTransform {
    /// No change: the image is a photograph of the real scene.
    pub const UNCHANGED: Self = Self { light: LightChange::SAME, shift: (0, 0) };

    /// Makes the real scene from an image.
    ///
    /// # Errors
    /// Returns [`ViewsError::Condensation`] if gain or gamma is not positive, or a number is not finite.
    pub fn of(&self, picture: &RgbImage) -> Result<RgbImage, ViewsError> {
        Ok(shifted(&self.light.apply(picture)?, self.shift.0, self.shift.1))
    }
}
