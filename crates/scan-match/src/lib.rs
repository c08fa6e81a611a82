//! Scan matching: the motion of a robot between two laser scans.
//!
//! Odometry predicts the motion with its covariance; the two scans measure it much better in all directions in which they have walls.
//! [`ScanMatcher::align`] finds the motion that fits both best, and returns the information of the scans alone, so a filter can weight them.
//!
//! ```
//! use nalgebra::{Matrix3, Vector3};
//! use wayfix_estimation_traits::{Manifold, Pose2};
//! use wayfix_scan_match::{ScanPointCloud, InitialGuess, ScanMatcher, ScanMatchParams};
//!
//! // A room of 8 m by 6 m, seen from its middle and from 20 cm further on.
//! let wall = |x: f64, bearing: f64| {
//!     let (sin, cos) = bearing.sin_cos();
//!     ((4.0 * cos.signum() - x) / cos).min(3.0 / sin.abs())
//! };
//! let beams = (0..360).map(|i| -3.13 + f64::from(i) * 0.0174);
//! let scan = |x: f64| beams.clone().map(|bearing| wall(x, bearing)).collect::<Vec<_>>();
//! let cloud = |x: f64| ScanPointCloud::from_ranges(-3.13, 0.0174, &scan(x), 20.0);
//!
//! let covariance = Matrix3::from_diagonal(&Vector3::new(0.01, 0.01, 0.01)); // σ 10 cm and 0.1 rad
//! let odometry = InitialGuess { pose: Pose2::new(0.15, 0.05, 0.1), covariance, alternative_poses: &[] };
//! let found = ScanMatcher::new(ScanMatchParams::default())?.align(&cloud(0.0)?, &cloud(0.2)?, &odometry)?;
//! assert!(Pose2::new(0.2, 0.0, 0.0).local(&found.pose).norm() < 0.01);
//! # Ok::<(), wayfix_scan_match::ScanMatchError>(())
//! ```
//!
//! Units are metres and radians, x forward, y left, in the frame of the laser. The crate has no filter and no map. Its accuracy in a map of walls is
//! in `docs/adr/0014-scan-matching-between-keyframes.md`. [Censi 2008; Chen & Medioni 1992]

mod cloud;
mod error;
mod matcher;
mod misfit;
mod params;
mod surface;
mod tree;

pub use cloud::ScanPointCloud;
pub use error::ScanMatchError;
pub use matcher::{InitialGuess, ScanAlignment, ScanMatcher};
pub use params::ScanMatchParams;
