use wayfix_gaussian_core::GaussianError;

/// Why an operation was refused. Whatever it was called on is as it was before.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
#[non_exhaustive]
pub enum AppearanceError {
    /// A reference with this number is in the map already.
    #[error("reference {id} is in the map already")]
    TwiceTheSame {
        /// Its number.
        id: u32,
    },
    /// A reference is named that the search does not hold.
    #[error("there is no view of reference {id}")]
    NoSuchReference {
        /// Its number.
        id: u32,
    },
    /// A distribution over poses has no meaning.
    #[error(transparent)]
    Gaussian(#[from] GaussianError),
    /// Something is NaN or infinite.
    #[error("{what} is not finite")]
    NotFinite {
        /// What it is.
        what: &'static str,
    },
    /// A parameter is outside its range.
    #[error("{what} is {value}, must be {range}")]
    Parameter {
        /// Which one.
        what: &'static str,
        /// Its value.
        value: f64,
        /// The values it may take.
        range: &'static str,
    },
    /// All numbers of references have been given out.
    #[error("no number is left for another reference")]
    Full,
}
