use wayfix_gaussian_core::{GaussianError, HierarchicalGaussianFit, IterationError};

/// Errors of learning or reading a prior.
/// ```
/// use wayfix_color_model::{LabelledPixels, LightingPriorError, YuvImage};
/// let image = YuvImage::new(2, 1, vec![[90, 110, 100]; 2])?;
/// let error = LabelledPixels::from_image(&image, (2, 1), &[3, 3], 2).unwrap_err();
/// assert_eq!(error, LightingPriorError::UnknownLabel { label: 3, n_pixels: 2, n_colors: 2 });
/// assert_eq!(error.to_string(), "2 pixels have the label 3: colours have 1 to 2, anything else 0");
/// # Ok::<(), wayfix_color_model::ColorModelError>(())
/// ```
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
#[non_exhaustive]
pub enum LightingPriorError {
    /// Fewer venues, or venues that differ, than groups to split them into.
    #[error("{got} different {what} do not make {needed} groups")]
    TooFew {
        /// Name of the missing elements.
        what: &'static str,
        /// The required number.
        needed: usize,
        /// The given number.
        got: usize,
    },
    /// A wrong number of elements.
    #[error("{what}: expected {expected}, got {got}")]
    Dimension {
        /// Name of the elements.
        what: &'static str,
        /// The expected number.
        expected: usize,
        /// The given number.
        got: usize,
    },
    /// A venue whose images show no map colour.
    #[error("no image of the venue {name} shows a colour")]
    Blank {
        /// Its name.
        name: String,
    },
    /// A colour that no image of a group of venues shows.
    #[error("no image of {} shows {color}: label it in one of them", .venues.join(", "))]
    UnseenColor {
        /// The names of the venues.
        venues: Vec<String>,
        /// The colour's name.
        color: String,
    },
    /// Labels of another size than their image.
    #[error("the image has {} × {} pixels, its labels {} × {}", .image.0, .image.1, .labels.0, .labels.1)]
    LabelSize {
        /// Columns and rows.
        image: (u32, u32),
        /// Columns and rows.
        labels: (u32, u32),
    },
    /// A label of no colour.
    #[error("{n_pixels} pixels have the label {label}: colours have 1 to {n_colors}, anything else 0")]
    UnknownLabel {
        /// The label.
        label: u8,
        /// Number of pixels with it.
        n_pixels: usize,
        /// Number of colours.
        n_colors: usize,
    },
    /// A number that is NaN, infinite or out of range.
    #[error("{what} is {value}")]
    OutOfRange {
        /// Name of the quantity.
        what: &'static str,
        /// The number.
        value: f64,
    },
    /// No venue has two images of the same colour, so the scatter of images cannot be learned: give it as a parameter.
    #[error("no colour is seen twice in a venue: the scatter of images is unknown")]
    UnknownScatter,
    /// A mean or covariance is none.
    #[error(transparent)]
    Gaussian(#[from] GaussianError),
    /// A prior was not found in the given number of iterations; with the last estimate.
    #[error("the prior of a group of venues: {0}")]
    Learning(#[from] IterationError<Box<HierarchicalGaussianFit>>),
}

/// A number that must be positive and finite.
pub(super) fn check_positive(what: &'static str, value: f64) -> Result<(), LightingPriorError> {
    if value > 0.0 && value.is_finite() {
        Ok(())
    } else {
        Err(LightingPriorError::OutOfRange { what, value })
    }
}

/// A correlation that leaves any number of coordinates a covariance: not negative, and below one.
pub(super) fn check_correlation(what: &'static str, value: f64) -> Result<(), LightingPriorError> {
    if (0.0..1.0).contains(&value) { Ok(()) } else { Err(LightingPriorError::OutOfRange { what, value }) }
}
