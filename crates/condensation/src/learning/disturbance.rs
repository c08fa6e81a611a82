use crate::LightChange;

/// How many numbers describe a [`UnknownShiftAndLight`].
pub const N_DISTURBANCES: usize = 5;

/// What is the same in all views of a run and unknown before it: by how much views are shifted and the light differs.
///
/// Used for values and for standard deviations.
#[derive(Clone, Copy, Debug, PartialEq)]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize), serde(deny_unknown_fields))]
pub struct UnknownShiftAndLight {
    /// Shift to the right, in pixels.
    pub dx: f64,
    /// Shift down, in pixels.
    pub dy: f64,
    /// What the gain has more than that of the condition.
    pub gain: f64,
    /// What the offset has more, in grey levels.
    pub offset: f64,
    /// Logarithm of what gamma is multiplied by.
    pub log_gamma: f64,
}

impl UnknownShiftAndLight {
    /// In the order of the fields.
    pub fn to_array(self) -> [f64; N_DISTURBANCES] {
        [self.dx, self.dy, self.gain, self.offset, self.log_gamma]
    }

    /// The light of a condition, changed by this.
    pub(crate) fn applied_to(&self, light: LightChange) -> LightChange {
        LightChange {
            gain: light.gain + self.gain,
            offset: light.offset + self.offset,
            gamma: light.gamma * self.log_gamma.exp(),
        }
    }

    /// In the order of the fields.
    pub(crate) fn from_array([dx, dy, gain, offset, log_gamma]: [f64; N_DISTURBANCES]) -> Self {
        Self { dx, dy, gain, offset, log_gamma }
    }
}
