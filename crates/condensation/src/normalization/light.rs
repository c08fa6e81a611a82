use image::RgbImage;

use crate::CondensationError;
use crate::error::checked;
use crate::features::mapped;

/// How a camera renders the light of a scene beside how it did when learning: $`J = g \cdot 255\, (I / 255)^γ + o`$.
#[derive(Clone, Copy, Debug, PartialEq)]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize), serde(deny_unknown_fields))]
pub struct LightChange {
    /// Contrast $`g`$.
    pub gain: f64,
    /// Brightness $`o`$, in grey levels.
    pub offset: f64,
    /// Bend $`γ`$ of the tone curve.
    pub gamma: f64,
}

impl LightChange {
    /// That of learning.
    pub const SAME: Self = Self { gain: 1.0, offset: 0.0, gamma: 1.0 };

    /// What each of the 256 values was in the light of learning: undoes [`table`](Self::table), but for what was clipped and rounded.
    ///
    /// # Errors
    /// As [`table`](Self::table).
    pub fn inverse_table(&self) -> Result<[u8; 256], CondensationError> {
        self.table()?;
        let value = |j: usize| ((j as f64 - self.offset) / (255.0 * self.gain)).clamp(0.0, 1.0);
        Ok(std::array::from_fn(|j| (255.0 * value(j).powf(1.0 / self.gamma)).round() as u8))
    }

    /// What becomes of each of the 256 values, rounded and clipped.
    ///
    /// # Errors
    /// [`CondensationError::Parameter`] when gain or gamma is not positive, or one of the three not finite.
    pub fn table(&self) -> Result<[u8; 256], CondensationError> {
        checked("gain", self.gain, self.gain.is_finite() && self.gain > 0.0, "finite and positive")?;
        checked("offset", self.offset, self.offset.is_finite(), "finite")?;
        checked("gamma", self.gamma, self.gamma.is_finite() && self.gamma > 0.0, "finite and positive")?;
        let value = |i: usize| self.gain * 255.0 * (i as f64 / 255.0).powf(self.gamma) + self.offset;
        Ok(std::array::from_fn(|i| value(i).round().clamp(0.0, 255.0) as u8))
    }

    /// A scene in this light.
    ///
    /// # Errors
    /// As [`table`](Self::table).
    pub fn apply(&self, scene: &RgbImage) -> Result<RgbImage, CondensationError> {
        Ok(mapped(scene, &[self.table()?; 3]))
    }
}
