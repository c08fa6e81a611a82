//! The joint covariance of robot and map, and the four things a filter does to it: move the robot, correct, grow, shrink.
//!
//! It comes in two forms: one matrix, or compressed, which tells the same and defers what a robot in one corner of a large map does to the rest of it.
//!
//! Every operation keeps it exactly symmetric, and positive semidefinite: what rounding may have taken from a variance is given back. Dense `n × n` products with the sparse observation Jacobian are never formed.

mod compressed;
mod correct;
mod joint;
mod map;
mod sparse;
mod triangular;

use joint::JointCovariance;
pub(crate) use map::MapCovariance;
pub(crate) use sparse::SparseJacobian;

/// Share of a variance that one operation gives back for its rounding: some hundreds of ε. A million operations add a part in ten million.
const ROUNDING: f64 = 1e-13;
