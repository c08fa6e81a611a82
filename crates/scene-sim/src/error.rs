/// Errors of setting up a simulation.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
#[non_exhaustive]
pub enum SimulationError {
    /// A parameter is out of range.
    #[error("{what} is {value}, must be {must}")]
    Parameter {
        /// Which parameter, with its unit.
        what: &'static str,
        /// Its value.
        value: f64,
        /// The requirement.
        must: &'static str,
    },
    /// The request exceeds the memory limit of a simulation.
    #[error("{what} is {got}, at most {limit} are possible")]
    TooMany {
        /// The excessive quantity.
        what: &'static str,
        /// The largest number possible.
        limit: u64,
        /// The requested number.
        got: u64,
    },
    /// Landmarks or waypoints that keep their distance do not fit.
    #[error("placed only {placed} of {wanted} {what}: there is no room for more")]
    NoRoom {
        /// The objects to place.
        what: &'static str,
        /// Number of placed objects.
        placed: usize,
        /// Number of requested objects.
        wanted: usize,
    },
    /// No scenario has this name.
    #[error("no scenario is called {name:?}")]
    UnknownScenario {
        /// The requested name.
        name: String,
    },
    /// The shapes do not make a map.
    #[cfg(feature = "league")]
    #[error(transparent)]
    Map(#[from] wayfix_color_map::ColorMapError),
    /// The numbers do not make a camera.
    #[cfg(feature = "league")]
    #[error(transparent)]
    View(#[from] wayfix_color_map::RenderError),
    /// A picture cannot be encoded.
    #[error("a picture cannot be encoded: {reason}")]
    Picture {
        /// The codec's error.
        reason: String,
    },
}

impl From<wayfix_sensor_log::ImageError> for SimulationError {
    fn from(error: wayfix_sensor_log::ImageError) -> Self {
        Self::Picture { reason: error.to_string() }
    }
}
