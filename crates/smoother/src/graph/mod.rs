//! Variables and residuals.

pub(crate) mod batch;
pub(crate) mod dense_quadratic;
mod factor_graph;
mod gaussian;
pub(crate) mod keys;
pub(crate) mod known_minimum;
mod linear_prior;
mod marginalize;
pub(crate) mod structure;
pub(crate) mod values;

pub use factor_graph::{Graph, ResidualId};
pub use marginalize::Marginalized;
