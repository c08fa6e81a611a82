use nalgebra::{Matrix1, Matrix2, Matrix3, Vector2};
use wayfix_estimation_traits::Pose2;

/// How a [`PointSmoother`](super::PointSmoother) works.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct PointSmootherParams {
    /// Poses older than this, in s, are dropped from the least squares problem; `None` keeps all, and [`finish`](super::PointSmoother::finish) solves once.
    pub lag: Option<f64>,
    /// The window is solved once in this time, s; short against the lag.
    pub period: f64,
    /// Pose of the sensor in the robot frame.
    pub mount: Pose2<f64>,
    /// Whether a detection in the window may become one of another landmark; not where the sensor reads identities. A batch keeps the pairings.
    pub pairs_anew: bool,
}

/// A measurement of the pose by a sensor that does not use the map.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum PoseObservation {
    /// Position of an antenna, m, with covariance.
    Position {
        /// The antenna in the robot frame.
        antenna: Vector2<f64>,
        /// Where it is.
        measured: Vector2<f64>,
        /// Covariance, m².
        covariance: Matrix2<f64>,
    },
    /// Heading, rad, with variance.
    Heading {
        /// Where the robot looks.
        measured: f64,
        /// Variance, rad².
        variance: Matrix1<f64>,
    },
    /// Pose, with covariance in the body frame.
    Pose {
        /// Where the robot is.
        measured: Pose2<f64>,
        /// Covariance, m² and rad².
        covariance: Matrix3<f64>,
    },
}

/// A pose that no later measurement will change.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct SettledPose {
    /// Its number: 0 for the start.
    pub number: usize,
    /// The estimate when it left the window.
    pub pose: Pose2<f64>,
    /// Its covariance in the body frame; zero in a batch, which computes none.
    pub covariance: Matrix3<f64>,
}
