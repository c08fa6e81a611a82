//! EKF-SLAM with consistent uncertainty: joint estimation of the robot pose and the landmark positions.
//!
//! The state is one robot pose and a growing number of landmarks,
//! $`x = (x_r, m_1, …, m_n)`$, with one joint covariance. A step of the filter reads
//!
//! ```text
//! predict      x_r ← f(x_r, u)                      O(n)      [predict]
//! associate    observations with landmarks          O(k n)    [DataAssociation]
//! gate         chi-squared test of each innovation  O(k)      [ObservationOutcome::Rejected]
//! correct      all accepted observations jointly    O(k n²)   sparse H, lower triangle, never indefinite
//! augment      certainly new landmarks              O(n)      tentative until confirmed
//! merge        duplicates                           O(n²)     [LandmarkMergingParams]
//! remove       tentative ones not observed again    O(n²)     [LandmarkConfirmationParams]
//! ```
//!
//! With [`CovarianceUpdate::Compressed`] the `n` in predict and correct is the number of landmarks around the robot, with the same estimates.
//!
//! A new kind of landmark implements [`LandmarkModel`]: expected measurement, noise, initialization. The rest is the same for
//! points, walls or radio beacons (`examples/02_custom_landmark_range_only.rs`); [`laws`] checks a model of your own.
//! `examples/01_slam_in_a_loop.rs` is a whole filter in six steps.
//!
//! [Andrade-Cetto 2005, Sec. 2; Dissanayake et al. 2001]
//!
//! [predict]: EkfSlam::predict

mod alloc;
pub mod association;
mod covariance;
mod error;
mod filter;
mod landmark;
pub mod laws;
mod models;
pub mod observability;
mod outcome;
mod snapshot;

pub use alloc::{LandmarkDim, MeasurementDim, RobotDim, SlamAlloc};
pub use association::{
    AnyAssociation, Association, DataAssociation, JointCompatibility, JointCompatibilityParams,
    KnownIdAssociation, NearestNeighbour, NearestNeighbourParams,
};
pub use error::SlamError;
pub use filter::{
    AnchorError, AnchorParams, CovarianceUpdate, EkfSlam, ExpectedLandmarks, LandmarkConfirmationParams,
    LandmarkEstimate, LandmarkMergingParams, LinearizationPoint, OutlierRule, PredictedMeasurement,
    SlamParams, UpdateOrder,
};
pub use landmark::{Innovation, LandmarkId, LandmarkModel, NewLandmark, Observation};
pub use models::{
    AckermannVehicle, CorrelatedNoise, ExternalError, ExternalParams, HeadingDriftSensor, HeadingSensor,
    LineDistanceSensor, LocalPlane, MapMeasurement, MonobotMotion, MotionStatistics, MotionWithRangeScale,
    MountedSensor, MovedSensor, OdometryMotion, PLANAR_SYMMETRIES, PlanarRobot, PoseSensor,
    PoseWithHeadingDrift, PoseWithRangeScale, PositionSensor, RangeBearing, RangeBearingSensor,
    RangeBearingSensorWithScale, RelativePosition, RelativePositionSensor, SensorWithHeadingDrift,
    SequentialMotion, UnknownMotion, VelocityControl, VelocityMotion, point_symmetry, pose_symmetry,
};
#[cfg(feature = "lines")]
pub use models::{Wall, WallLine, WallMeasurement, WallSensor};
pub use outcome::{LandmarkMerge, ObservationOutcome, RobotInnovation, UpdateReport};
pub use snapshot::{SavedLandmark, SavedRetiredLandmark, SlamSnapshot};

/// The matrix library of every public signature.
pub use wayfix_estimation_traits::nalgebra;
