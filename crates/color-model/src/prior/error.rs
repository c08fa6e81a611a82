use wayfix_gaussian_core::{GaussianError, HierarchicalFit, IterationError};

/// Why no prior was learned, or a stored one is none.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
#[non_exhaustive]
pub enum PriorError {
    /// Fewer venues, or venues that differ, than groups to split them into.
    #[error("{got} different {what} do not make {needed} groups")]
    TooFew {
        /// What there should be more of.
        what: &'static str,
        /// How many are needed.
        needed: usize,
        /// How many there are.
        got: usize,
    },
    /// Something has not as many parts as it should.
    #[error("{what}: expected {expected}, got {got}")]
    Dimension {
        /// What was counted.
        what: &'static str,
        /// How many there should be.
        expected: usize,
        /// How many there are.
        got: usize,
    },
    /// A venue whose images show no colour at all.
    #[error("no image of the venue {name} shows a colour")]
    Blank {
        /// Its name.
        name: String,
    },
    /// A colour that no image of a group of venues shows.
    #[error("no image of group {group} shows {color}")]
    UnseenColor {
        /// Which group, from dark to bright.
        group: usize,
        /// The colour's name.
        color: String,
    },
    /// A number that is NaN, infinite or out of range.
    #[error("{what} is {value}")]
    OutOfRange {
        /// What it is.
        what: &'static str,
        /// The number.
        value: f64,
    },
    /// No venue has two images of the same colour, from which the scatter of images could be learned: give it as a parameter.
    #[error("no colour is seen twice in a venue: the scatter of images is unknown")]
    UnknownScatter,
    /// A mean or covariance is none.
    #[error(transparent)]
    Gaussian(#[from] GaussianError),
    /// A prior was not found in the given number of iterations; with the last estimate.
    #[error("the prior of a group of venues: {0}")]
    Learning(#[from] IterationError<Box<HierarchicalFit>>),
}

/// A number that must be positive and finite.
pub(super) fn check_positive(what: &'static str, value: f64) -> Result<(), PriorError> {
    if value > 0.0 && value.is_finite() { Ok(()) } else { Err(PriorError::OutOfRange { what, value }) }
}

/// A correlation that leaves any number of coordinates a covariance: not negative, and below one.
pub(super) fn check_correlation(what: &'static str, value: f64) -> Result<(), PriorError> {
    if (0.0..1.0).contains(&value) { Ok(()) } else { Err(PriorError::OutOfRange { what, value }) }
}
