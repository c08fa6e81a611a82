use serde::{Deserialize, Serialize};

use crate::settings::over_defaults;

/// Everything that `wayfix run track` is tuned by; none of it depends on the recording.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct TrackParams {}

impl TrackParams {
    /// The defaults, with what a TOML text names in their place.
    ///
    /// # Errors
    /// When the text is no TOML, or names a key that does not exist or a value of another kind.
    pub fn from_toml(text: &str) -> Result<Self, toml::de::Error> {
        over_defaults(&Self::default(), text)
    }
}
