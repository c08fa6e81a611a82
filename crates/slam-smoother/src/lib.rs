//! Graph SLAM: all poses and landmarks as the minimum of one sum of squares.
//!
//! | to | use |
//! | --- | --- |
//! | place beacons that tell distances only, and the path among them | [`range_only::estimate`] |
//! | smooth a path among points seen in range and bearing, with a fixed lag or in a batch | [`points::PointSmoother`] |
//!
//! Logs and files are for other crates: inputs are motions and measurements with their poses.

mod error;
pub mod points;
pub mod range_only;

pub use error::SlamSmootherError;

/// The matrix library of every public signature, re-exported because its versions do not mix.
pub use nalgebra;
