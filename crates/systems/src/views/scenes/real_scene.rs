use wayfix_condensation::{Light, Picture};

use super::super::ViewsError;

/// How the real scene is made of a picture: other light, then a camera some pixels aside.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct RealScene {
    /// The light.
    pub light: Light,
    /// Pixels to the right and down.
    pub shift: (i32, i32),
}

impl Default for RealScene {
    /// Less contrast, more brightness, a bent tone curve, and a camera 4 and 3 pixels aside.
    fn default() -> Self {
        Self { light: Light { gain: 0.7, offset: 20.0, gamma: 1.3 }, shift: (4, 3) }
    }
}

impl RealScene {
    /// The picture as it is: a real scene that somebody photographed.
    pub const UNCHANGED: Self = Self { light: Light::SAME, shift: (0, 0) };

    /// The real scene.
    ///
    /// # Errors
    /// [`ViewsError::Condensation`] when gain or gamma is not positive, or a number not finite.
    pub fn of(&self, picture: &Picture) -> Result<Picture, ViewsError> {
        Ok(self.light.apply(picture)?.shifted(self.shift.0, self.shift.1))
    }
}
