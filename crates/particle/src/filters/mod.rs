//! Filters put together from a motion model, a likelihood model and a set of particles.

mod auxiliary;
mod bootstrap;

pub use auxiliary::AuxiliaryFilter;
pub use bootstrap::BootstrapFilter;
