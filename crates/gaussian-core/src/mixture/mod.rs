//! Weighted sums of Gaussians, and ways to keep them small.

mod density;
mod log_sum_exp;
mod model;
mod prune;
mod runnalls;
mod west;

pub use log_sum_exp::log_sum_exp;
pub use model::Mixture;
