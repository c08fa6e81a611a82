use clap::ValueEnum;
use serde::{Deserialize, Serialize};
use wayfix_condensation::{AppearanceParams, Picture, light_match};

use super::{ViewsError, ViewsParams};

/// How today's light is made that of learning.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, PartialOrd, Ord, ValueEnum, Serialize, Deserialize)]
#[serde(rename_all = "kebab-case")]
pub enum Normalization {
    /// Not at all: the views are taken as they come.
    None,
    /// By the statistics of the whole real scene, as the paper presumes; a robot that sees one view at a time has not got them.
    #[default]
    WholeScene,
    /// Not before the run: the light is estimated together with the place, from the views seen so far.
    Online,
}

impl Normalization {
    /// Its name in figures.
    pub fn name(self) -> &'static str {
        match self {
            Self::None => "none",
            Self::WholeScene => "whole_scene",
            Self::Online => "online",
        }
    }

    /// How appearance is learned for it.
    pub fn appearance(self, params: &ViewsParams) -> &AppearanceParams {
        match self {
            Self::None | Self::WholeScene => &params.whole_scene,
            Self::Online => &params.online,
        }
    }

    /// The real scene as features are taken of it.
    ///
    /// # Errors
    /// [`ViewsError::NoContrast`] when there is nothing to match light by.
    pub fn apply(self, real: &Picture, learned: &Picture) -> Result<Picture, ViewsError> {
        match self {
            Self::None | Self::Online => Ok(real.clone()),
            Self::WholeScene => {
                let light =
                    light_match(real, learned).ok_or(ViewsError::NoContrast { which: "learned scene" })?;
                Ok(real.mapped(&[light.inverse_table()?; 3]))
            }
        }
    }
}
