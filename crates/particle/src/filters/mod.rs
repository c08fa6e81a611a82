//! Filters put together from a motion model, a likelihood model and a set of particles.

mod auxiliary;
mod bootstrap;
mod likely_motion;
mod seeded_filter;

pub use auxiliary::AuxiliaryFilter;
pub use bootstrap::BootstrapFilter;
pub use likely_motion::LikelyMotion;
pub use seeded_filter::SeededFilter;
