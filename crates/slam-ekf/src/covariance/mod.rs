//! The joint covariance of robot and map, and the four operations of a filter on it: move the robot, correct, grow, shrink.
//!
//! It has two forms: one matrix, or compressed, with the same values and deferred updates of the map outside the area around the robot.
//!
//! Every operation keeps it exactly symmetric and positive semidefinite: a rounding allowance is added to the variances. Dense `n × n` products with
//! the sparse observation Jacobian are never formed.

mod compressed;
mod correct;
mod joint;
mod map;
mod sparse;
mod triangular;

use joint::JointCovariance;
pub(crate) use map::MapCovariance;
pub(crate) use sparse::SparseJacobian;

/// Rounding allowance of one operation as a share of a variance: some hundreds of ε. A million operations add a part in ten million.
const ROUNDING: f64 = 1e-13;
