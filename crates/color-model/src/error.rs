use wayfix_gaussian_core::GaussianError;
use wayfix_integrity::IntegrityError;
use wayfix_kalman::KalmanError;
use wayfix_particle::ParticleError;

/// Errors of a colour model. After an error, the model is unchanged.
/// ```
/// use wayfix_color_model::{ColorModelError, YuvImage};
/// let error = YuvImage::new(2, 2, vec![[0, 128, 128]; 3]).unwrap_err();
/// assert_eq!(error, ColorModelError::ImageSize { width: 2, height: 2, expected: 12, got: 9 });
/// assert_eq!(error.to_string(), "an image of 2 x 2 pixels needs 12 bytes, got 9");
/// ```
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
#[non_exhaustive]
pub enum ColorModelError {
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
    /// A number that is NaN or infinite.
    #[error("{what} is not finite")]
    NotFinite {
        /// Name of the quantity.
        what: &'static str,
    },
    /// A number outside the range that has a meaning.
    #[error("{what}: {value} is out of range")]
    OutOfRange {
        /// Name of the quantity.
        what: &'static str,
        /// The number.
        value: f64,
    },
    /// A colour's density with a mean that is not finite or a covariance that is not positive definite.
    #[error("the density of a colour has no peak: mean not finite or covariance not positive definite")]
    DensityNotPositive,
    /// An image without pixels, or with a wrong number of bytes.
    #[error("an image of {width} x {height} pixels needs {expected} bytes, got {got}")]
    ImageSize {
        /// Columns.
        width: usize,
        /// Rows.
        height: usize,
        /// Bytes that are needed; 0 for an image that is too large to be one.
        expected: usize,
        /// Number of bytes given.
        got: usize,
    },
    /// An image that differs from the camera in size, as (columns, rows).
    #[error("frame of {} x {} pixels from a camera of {} x {}", got.0, got.1, expected.0, expected.1)]
    FrameSize {
        /// The camera's.
        expected: (usize, usize),
        /// The image's.
        got: (usize, usize),
    },
    /// A map whose global search would not end.
    #[error(
        "a global search of a map of {width:.0} x {depth:.0} m takes {n_samples:.1e} poses, more than {most}: are its lengths in metres? (0 samples per place track from a known start without a search)"
    )]
    MapTooLarge {
        /// Along x, m.
        width: f64,
        /// Along y, m.
        depth: f64,
        /// Poses of a search.
        n_samples: f64,
        /// As many would be searched.
        most: usize,
    },
    /// A row too long for exact sums.
    #[error("rows of {width} pixels are longer than {limit}, beyond which sums would overflow")]
    TooWide {
        /// Pixels in a row.
        width: usize,
        /// Longest row.
        limit: usize,
    },
    /// A map without any surface.
    #[error("the map has no surfaces")]
    EmptyMap,
    /// The particles do not have a mean pose.
    #[error("the particles have no common pose")]
    NoPose,
    /// No member of the bank.
    #[error("the bank has {n_members} lighting filters, no number {member}")]
    NoSuchMember {
        /// The given index.
        member: usize,
        /// Number of members.
        n_members: usize,
    },
    /// A mean or covariance is none.
    #[error(transparent)]
    Gaussian(#[from] GaussianError),
    /// An error of a filter.
    #[error(transparent)]
    Kalman(#[from] KalmanError),
    /// An error of the change test.
    #[error(transparent)]
    Integrity(#[from] IntegrityError),
    /// An error of the particles.
    #[error(transparent)]
    Particle(#[from] ParticleError),
}
