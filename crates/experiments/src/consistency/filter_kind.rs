use nalgebra::Vector3;
use wayfix_evaluation::errors::PoseWithTruth;
use wayfix_slam_ekf::LinearizationPoint;

/// The filters that are compared.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum ComparedFilter {
    /// All derivatives at the newest estimate, with no reference to the world.
    Standard,
    /// The same, with some landmarks at known positions. [Andrade-Cetto 2005, Eq. 20]
    Anchored,
    /// First-estimates Jacobians. [Huang et al. 2010]
    FirstEstimates,
    /// The right-invariant filter. [Barrau & Bonnabel 2015]
    Invariant,
}

impl ComparedFilter {
    /// All of them, in the order of the report.
    pub const ALL: [Self; 4] = [Self::Standard, Self::Anchored, Self::FirstEstimates, Self::Invariant];

    /// Its name in figures.
    pub fn name(self) -> &'static str {
        match self {
            Self::Standard => "standard",
            Self::Anchored => "known_landmarks",
            Self::FirstEstimates => "first_estimates",
            Self::Invariant => "invariant",
        }
    }

    /// Linearization points.
    pub fn linearization(self) -> LinearizationPoint {
        match self {
            Self::Standard | Self::Anchored => LinearizationPoint::Newest,
            Self::FirstEstimates => LinearizationPoint::FirstEstimates,
            Self::Invariant => LinearizationPoint::Invariant,
        }
    }

    /// The error in the coordinates in which the filter takes it for Gaussian: exponential ones for the invariant filter.
    ///
    /// ```
    /// use wayfix_evaluation::errors::PoseWithTruth;
    /// use wayfix_experiments::consistency::ComparedFilter;
    /// use nalgebra::Matrix3;
    /// use wayfix_estimation_traits::Pose2;
    /// let (estimate, truth) = (Pose2::new(0.0, 0.0, 0.0), Pose2::new(1.0, 0.0, 0.2));
    /// let sample = PoseWithTruth { estimate, covariance: Matrix3::identity(), truth };
    /// assert!(ComparedFilter::Standard.error(&sample).y.abs() < 1e-12);
    /// assert!((ComparedFilter::Invariant.error(&sample).y + 0.1).abs() < 1e-12); // half the turn, over one metre
    /// ```
    pub fn error(self, sample: &PoseWithTruth) -> Vector3<f64> {
        match self {
            Self::Invariant => sample.exponential_error(),
            _ => sample.error(),
        }
    }
}
