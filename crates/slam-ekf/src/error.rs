use crate::LandmarkId;

/// Errors of the filter. After an error the filter is unchanged.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
#[non_exhaustive]
pub enum SlamError {
    /// A control, pose, landmark or noise is NaN or infinite.
    #[error("{what} is not finite")]
    NotFinite {
        /// Name of the quantity.
        what: &'static str,
    },
    /// A noise or covariance is not symmetric positive (semi)definite.
    #[error(
        "{what} is not a covariance: its smallest eigenvalue or pivot is {value:e}, its asymmetry {asymmetry:e}"
    )]
    NotACovariance {
        /// Which matrix.
        what: &'static str,
        /// The offending eigenvalue or pivot.
        value: f64,
        /// Largest difference across the diagonal.
        asymmetry: f64,
    },
    /// A dimension does not match.
    #[error("{what} has dimension {got}, expected {expected}")]
    Dimension {
        /// Name of the quantity with the wrong size.
        what: &'static str,
        /// The expected size.
        expected: usize,
        /// The size given.
        got: usize,
    },
    /// A landmark with this identity is in the map already.
    #[error("landmark {0} is in the map already")]
    LandmarkExists(LandmarkId),
    /// A measurement is rejected as an outlier.
    #[error("an outlier: its NIS is {nis}, the gate is at {threshold}")]
    Outlier {
        /// Normalized innovation squared.
        nis: f64,
        /// The gate.
        threshold: f64,
    },
    /// First-estimates and invariant filters need the symmetries of the landmark model.
    #[error("this linearization needs a landmark model that implements `symmetries`")]
    NoSymmetry,
    /// The invariant filter moves the whole map with every correction, which a compressed map defers.
    #[error(
        "the invariant linearization moves the whole map at every correction: it needs the full form of the map"
    )]
    InvariantNeedsFullMap,
    /// A parameter is outside its range.
    #[error("parameter {name} is {value:?}, must be {range}")]
    Parameter {
        /// Its name.
        name: &'static str,
        /// Its value.
        value: f64,
        /// Its range.
        range: &'static str,
    },
}
