/// Why a simulation cannot be set up.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
#[non_exhaustive]
pub enum SimError {
    /// A parameter is out of range.
    #[error("{what} is {value}, must be {must}")]
    Parameter {
        /// Which parameter, with its unit.
        what: &'static str,
        /// Its value.
        value: f64,
        /// What it must be.
        must: &'static str,
    },
    /// More is requested than a simulation holds in memory.
    #[error("{what} is {got}, at most {limit} are possible")]
    TooMany {
        /// What there is too much of.
        what: &'static str,
        /// The largest number possible.
        limit: u64,
        /// The number asked for.
        got: u64,
    },
    /// Landmarks or waypoints that keep their distance do not fit.
    #[error("placed only {placed} of {wanted} {what}: there is no room for more")]
    NoRoom {
        /// What was to be placed.
        what: &'static str,
        /// How many found room.
        placed: usize,
        /// How many were asked for.
        wanted: usize,
    },
    /// No scenario has this name.
    #[error("no scenario is called {name:?}")]
    UnknownScenario {
        /// The name asked for.
        name: String,
    },
    /// The shapes do not make a map.
    #[cfg(feature = "league")]
    #[error(transparent)]
    Map(#[from] wayfix_color_map::MapError),
    /// The numbers do not make a camera.
    #[cfg(feature = "league")]
    #[error(transparent)]
    View(#[from] wayfix_color_map::ViewError),
    /// A picture cannot be encoded.
    #[error("a picture cannot be encoded: {reason}")]
    Picture {
        /// What the codec says.
        reason: String,
    },
}

impl From<wayfix_sensor_log::ImageError> for SimError {
    fn from(error: wayfix_sensor_log::ImageError) -> Self {
        Self::Picture { reason: error.to_string() }
    }
}
