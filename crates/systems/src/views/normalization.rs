use clap::ValueEnum;
use serde::{Deserialize, Serialize};
use wayfix_condensation::{AppearanceLearningParams, RgbImage, light_match, mapped};

use super::{ViewsError, ViewsParams};

/// Normalization of the current light to that of learning.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, PartialOrd, Ord, ValueEnum, Serialize, Deserialize)]
#[serde(rename_all = "kebab-case")]
pub enum LightNormalization {
    /// None: the views are used as they are.
    None,
    /// By the statistics of the whole real scene, as in the paper; a robot with one view at a time does not have them.
    #[default]
    WholeScene,
    /// During the run: the light is estimated jointly with the place, from the views so far.
    Online,
}

impl LightNormalization {
    /// Its name in figures.
    pub fn name(self) -> &'static str {
        match self {
            Self::None => "unnormalized",
            Self::WholeScene => "scene_normalized",
            Self::Online => "light_estimated",
        }
    }

    /// Parameters of the appearance learned for this normalization.
    pub fn appearance(self, params: &ViewsParams) -> &AppearanceLearningParams {
        match self {
            Self::None | Self::WholeScene => &params.scene_normalized_appearance_learning,
            Self::Online => &params.light_estimated_appearance_learning,
        }
    }

    /// The real scene, normalized for the features.
    ///
    /// # Errors
    /// Returns [`ViewsError::NoContrast`] if there is no contrast to match.
    pub fn apply(self, real: &RgbImage, learned: &RgbImage) -> Result<RgbImage, ViewsError> {
        match self {
            Self::None | Self::Online => Ok(real.clone()),
            Self::WholeScene => {
                let light =
                    light_match(real, learned).ok_or(ViewsError::NoContrast { which: "learned scene" })?;
                Ok(mapped(real, &[light.inverse_table()?; 3]))
            }
        }
    }
}
