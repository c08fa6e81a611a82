//! A straight line, its covariance, and its fit to points.

mod estimate;
mod fit;
mod hessian;
mod moments;

pub use estimate::LineEstimate;
pub use fit::{LineFit, fit_line};
pub use hessian::HessianLine;

pub(crate) use moments::Moments;
