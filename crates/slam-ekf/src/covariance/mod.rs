//! The joint covariance of robot and map, and the four things a filter does to it: move the robot, correct, grow, shrink.
//!
//! Every operation keeps it exactly symmetric. Dense `n × n` products with the sparse observation Jacobian are never formed.

mod correct;
mod joint;
mod sparse;
mod triangular;

pub(crate) use joint::JointCovariance;
pub(crate) use sparse::SparseJacobian;
