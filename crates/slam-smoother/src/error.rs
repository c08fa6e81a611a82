use wayfix_smoother::SmootherError;

/// Why nothing can be estimated.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
#[non_exhaustive]
pub enum SlamSmootherError {
    /// A number that is not what it has to be.
    #[error("{what} {index} is {value}; it must be {wanted}")]
    OutOfRange {
        /// Which kind of number.
        what: &'static str,
        /// Its place among its kind.
        index: usize,
        /// Its value.
        value: f64,
        /// What it has to be.
        wanted: &'static str,
    },
    /// A measurement from a pose that no motion leads to.
    #[error("range {index} is measured from pose {pose}, but there are {n_poses} poses")]
    UnknownPose {
        /// Number of the range.
        index: usize,
        /// The pose it names.
        pose: usize,
        /// Number of poses.
        n_poses: usize,
    },
    /// A landmark that is not in the map.
    #[error("landmark {landmark} is not in the map of the smoother")]
    UnknownLandmark {
        /// Its identity.
        landmark: u32,
    },
    /// A problem with residuals that its text has no lines for.
    #[error(
        "{n_residuals} residuals are neither motions nor detections: measurements of the pose, or what was marginalized"
    )]
    NotExported {
        /// Number of these residuals.
        n_residuals: usize,
    },
    /// No beacon has a place: there are too few ranges, or they leave two places each.
    #[error(
        "none of {n_beacons} beacons can be placed by {n_ranges} ranges: the path must turn, and a beacon needs at least {min_ranges} ranges"
    )]
    NoBeacon {
        /// Number of beacons.
        n_beacons: usize,
        /// Number of ranges.
        n_ranges: usize,
        /// Fewest ranges that place a beacon.
        min_ranges: usize,
    },
    /// The least squares problem cannot be solved.
    #[error(transparent)]
    Smoother(#[from] SmootherError),
}
