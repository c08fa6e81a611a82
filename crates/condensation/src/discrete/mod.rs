//! Belief over a finite set of states: spaces, transitions, diffusion, the filter and what watches it.

mod chunks;
mod dense;
mod diffusion;
mod filter;
mod grid;
mod heading_grid;
mod lattice;
mod outcome;
mod slip;
mod space;
mod sparse;
mod transition;

pub use dense::DenseTransition;
pub use diffusion::DiffusionKernel;
pub(crate) use filter::entropy;
pub use filter::{DiscreteFilter, MostProbableState};
pub use grid::{GridMove, PositionGrid};
pub use heading_grid::{HeadingGrid, Maneuver};
pub use lattice::{LatticeAxis, StateLattice};
pub use outcome::{MeasurementEvidence, MeasurementOutcome};
pub use slip::SlipProbabilities;
pub use space::DiscreteStateSpace;
pub use sparse::SparseTransition;
pub use transition::TransitionModel;
