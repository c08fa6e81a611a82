//! State condensation: a robot that finds out in which of finitely many places it is from what the whole picture looks like.

mod discrete;
mod error;

pub use discrete::{
    Axis, BestState, DenseTransition, DiffusionKernel, DiscreteFilter, Evidence, Follow, Graph, Grid,
    HeadingGrid, KidnapMonitor, Lattice, Maneuver, Move, Outcome, Slip, SparseTransition, StateSpace,
    Transition,
};
pub use error::CondensationError;
