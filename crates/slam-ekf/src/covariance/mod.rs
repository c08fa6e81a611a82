//! The joint covariance of robot and map, and the four things a filter does to it: move the robot, correct, grow, shrink.
//!
//! Every operation keeps it exactly symmetric, and positive semidefinite: what rounding may have taken from a variance is given back. Dense `n × n` products with the sparse observation Jacobian are never formed.

mod correct;
mod joint;
mod sparse;
mod triangular;

pub(crate) use joint::JointCovariance;
pub(crate) use sparse::SparseJacobian;

/// Share of a variance that one operation gives back for its rounding: some hundreds of ε. A million operations add a part in ten million.
const ROUNDING: f64 = 1e-13;
