use wayfix_gaussian_core::GaussianError;
use wayfix_particle::ParticleError;

/// Errors of this crate. After an error, the object is unchanged.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
#[non_exhaustive]
pub enum TrackingError {
    /// A collection that must not be empty is empty.
    #[error("no {what}")]
    Empty {
        /// Name of the collection.
        what: &'static str,
    },
    /// Sizes do not fit.
    #[error("{what} has size {got}, expected {expected}")]
    Dimension {
        /// Name of the quantity with the wrong size.
        what: &'static str,
        /// The size that fits.
        expected: usize,
        /// The size that came.
        got: usize,
    },
    /// A number is NaN or infinite where it must not be.
    #[error("{what} {index} is {value}")]
    NotFinite {
        /// Name of the quantity.
        what: &'static str,
        /// Its position in its list.
        index: usize,
        /// The number.
        value: f64,
    },
    /// A parameter or a probability is outside its range.
    #[error("{what} is {value}, must be {range}")]
    Parameter {
        /// Path of the file.
        what: &'static str,
        /// Its value.
        value: f64,
        /// The allowed range.
        range: &'static str,
    },
    /// A state space, a picture or a window has a side of zero, or more cells than can be counted.
    #[error("{what} of size {size:?}")]
    Extent {
        /// Name of the quantity.
        what: &'static str,
        /// Its sides.
        size: Vec<usize>,
    },
    /// A box has no pixel of the picture in it.
    #[error("the box {bounding_box:?} lies outside a picture of {picture:?}")]
    OutsidePicture {
        /// Left, top, width and height.
        bounding_box: [f64; 4],
        /// Width and height of the picture.
        picture: (usize, usize),
    },
    /// The pixel is outside the image.
    #[error("pixel {pixel:?} is outside {size:?}")]
    Outside {
        /// Its column and row.
        pixel: (usize, usize),
        /// Width and height.
        size: (usize, usize),
    },
    /// A covariance cannot be used.
    #[error(transparent)]
    Gaussian(#[from] GaussianError),
    /// Samples cannot be drawn or weighed.
    #[error(transparent)]
    Particle(#[from] ParticleError),
}

/// Returns `value` if it lies in `range`.
pub(crate) fn checked(
    what: &'static str,
    value: f64,
    valid: bool,
    range: &'static str,
) -> Result<f64, TrackingError> {
    if valid { Ok(value) } else { Err(TrackingError::Parameter { what, value, range }) }
}

/// `value` as a probability, both ends included.
pub(crate) fn probability(what: &'static str, value: f64) -> Result<f64, TrackingError> {
    checked(what, value, (0.0..=1.0).contains(&value), "between 0 and 1")
}

/// Whether sizes agree.
pub(crate) fn check_size(what: &'static str, expected: usize, got: usize) -> Result<(), TrackingError> {
    if expected == got { Ok(()) } else { Err(TrackingError::Dimension { what, expected, got }) }
}
