//! The square-root form: the Cholesky factor is carried, the covariance never formed.

mod belief;
mod form;
mod rotation;

pub use belief::FactoredGaussian;
pub use form::SquareRootKalmanAlgorithm;
