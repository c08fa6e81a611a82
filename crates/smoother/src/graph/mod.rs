//! Variables and residuals.

pub(crate) mod batch;
mod factor_graph;
pub(crate) mod keys;
pub(crate) mod structure;
pub(crate) mod values;

pub use factor_graph::{Graph, ResidualId};
