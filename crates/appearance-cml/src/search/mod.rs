//! Which reference views look like the view of this moment.

mod descriptor;
mod linear;
mod reference_search;

pub use descriptor::{Comparison, Descriptor};
pub use linear::LinearSearch;
pub use reference_search::{Match, ReferenceId, ReferenceSearch};
