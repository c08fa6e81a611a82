//! Which reference views look like the view of this moment.

mod bound_table;
mod bounded;
mod box_tree;
mod descriptor;
mod index;
mod linear;
mod nearest;
mod projection;
mod reference_search;
mod slot_set;

pub use bound_table::{BoundTable, NoBoundTable};
pub use bounded::LowerBoundedDistance;
pub use descriptor::{Descriptor, ViewDifference};
pub use index::{AppearanceIndex, SearchStatistics};
pub use linear::LinearSearch;
pub use reference_search::{ReferenceId, ReferenceMatch, ReferenceSearch};
