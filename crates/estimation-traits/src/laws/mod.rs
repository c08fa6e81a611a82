//! Law suites: run them on your own types.
//!
//! Each suite returns the first [`Violation`] with numbers instead of panicking, so that it serves in tests
//! (`laws::manifold(&points).unwrap()`) and in tools.

mod violation;
pub use violation::Violation;
