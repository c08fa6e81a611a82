//! Weighted sums of Gaussians, and methods to reduce them.

mod density;
mod log_sum_exp;
mod model;
mod prune;
mod runnalls;
mod west;

pub use log_sum_exp::log_sum_exp;
pub use model::GaussianMixture;
