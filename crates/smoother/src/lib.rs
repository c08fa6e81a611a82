//! Sparse nonlinear least squares on manifolds: what a filter cannot take back, a smoother can.
//!
//! A [`Graph`] holds variables on any manifold of `wayfix-estimation-traits` and residuals between them. [`Graph::optimize`] moves the
//! variables to the minimum of $`\sum ρ(r^T Ω r)`$: linearize, solve, retract, judge.
//!
//! | to | use |
//! | --- | --- |
//! | estimate poses, points or values of your own | [`Graph::add_variable`], any [`Variable`] |
//! | measure motions, absolute poses, landmarks | [`Between`], [`Prior`], [`RelativePosition`] |
//! | measure something else | implement [`Residual`], check it by [`laws::residual`] |
//! | tolerate outliers | [`Kernel`], [`Params::graduated`] |
//! | keep a window of recent variables | [`Graph::marginalize`] |
//! | know how certain the result is | [`Graph::marginals`] |
//! | read a pose graph, start it linearly, write it | [`g2o`] |
//!
//! The normal equations are sparse and factorized by the Cholesky factorization of `faer`, on one thread: the same graph gives the same bits.
//! Information matrices are inverse covariances; the cost has no factor ½. Tangent vectors are in the body frame.

mod error;
pub mod g2o;
mod graph;
mod information;
mod kernel;
pub mod laws;
mod linear;
mod marginals;
mod optimize;
mod residual;
mod residuals;
mod unconstrained;
mod variable;
mod variable_tuple;

pub use error::SmootherError;
pub use graph::{Graph, Marginalized, ResidualId};
pub use kernel::Kernel;
pub use marginals::Marginals;
pub use optimize::{Method, Params, Stop, Summary};
pub use residual::{Ids, Information, Jacobians, Refs, Residual, Value};
pub use residuals::{Between, Prior, RelativePosition};
pub use unconstrained::UnconstrainedDirection;
pub use variable::{Variable, VariableId};
pub use variable_tuple::VariableTuple;

/// The matrix library of every public signature, re-exported because its versions do not mix.
pub use nalgebra;
