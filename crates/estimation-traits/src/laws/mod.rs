//! Law suites: run them on your own types.
//!
//! Each suite returns the first [`LawViolation`] with numbers instead of panicking, so that it serves in tests
//! (`laws::manifold(&points).unwrap()`) and in tools. `examples/02_custom_state.rs` runs them on a state of its own.

mod check;
mod filter;
mod jacobian;
mod lie_group;
mod likelihood;
mod manifold;
mod models;
#[cfg(feature = "sampling")]
mod sample_motion;
mod tangents;
mod violation;

pub use check::within;
pub use filter::{FilterLawCall, FilterLawTrial, filter};
pub use lie_group::lie_group;
pub use likelihood::likelihood;
pub use manifold::{manifold, periodic};
pub use models::{motion, sensor};
#[cfg(feature = "sampling")]
pub use sample_motion::sample_motion;
pub use violation::LawViolation;
