//! Polyline simplification: Douglas-Peucker, plain and with a tree of hulls.

mod baseline;
mod chain;
mod classic;
mod exact;
mod hull_tree;
mod query;
mod scan;
mod simplifier;
mod split;

pub use classic::{PointDistanceReference, douglas_peucker};
pub use simplifier::{PolylineSimplifier, simplify};

pub(crate) use split::first_max;
