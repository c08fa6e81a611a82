//! Residuals that most graphs need.

mod between;
mod prior;
mod relative_position;

pub use between::Between;
pub use prior::Prior;
pub use relative_position::RelativePosition;
