//! Which reference views look like the view of this moment.

mod bound_table;
mod bounded;
mod descriptor;
mod index;
mod linear;
mod nearest;
mod reference_search;

pub use bound_table::{LowerBoundTable, WithoutLowerBounds};
pub use bounded::LowerBoundedDistance;
pub use descriptor::{ViewDescriptor, ViewDifference};
pub use index::{AppearanceIndex, SearchStatistics};
pub use linear::LinearSearch;
pub use reference_search::{ReferenceId, ReferenceMatch, ReferenceSearch};
