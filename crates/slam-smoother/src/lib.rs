//! Graph SLAM: all poses and landmarks as the minimum of one sum of squares.
//!
//! | to | use |
//! | --- | --- |
//! | place beacons that tell distances only, and the path among them | [`range_only::estimate`] |
//! | smooth a path among points seen in range and bearing, with a fixed lag or in a batch | [`points::PointSmoother`] |
//!
//! Logs and files are for other crates: inputs are motions and measurements with their poses.

use wayfix_smoother::Kernel;

mod error;
pub mod points;
pub mod range_only;

pub use error::SlamSmootherError;

/// Kernel of measurements: 95 % of the efficiency of least squares when there are no outliers. [Holland and Welsch 1977] Its cost is that of Student's t with
/// $`c^2 - 1`$ degrees of freedom, so that the noise has a likelihood. [Lange et al. 1989]
pub const ROBUST_KERNEL: Kernel = Kernel::Cauchy { c: 2.385 };

/// The matrix library of every public signature, re-exported because its versions do not mix.
pub use nalgebra;
