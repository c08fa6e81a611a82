//! The experiments of the paper, and further ones, for `wayfix-experiments regress color`.

mod broad_priors;
mod convergence;
mod frame_time;
mod halls;
mod real_places;
mod switching;
mod training;
mod withheld;

pub(crate) use broad_priors::learn_broad_priors;
pub(crate) use convergence::{global_start, kidnapped};
pub(crate) use frame_time::frame_time;
pub(crate) use halls::other_halls;
pub(crate) use real_places::real_places;
pub(crate) use switching::switching;
pub(crate) use training::TrainingHalls;
pub(crate) use withheld::{compared, withheld, withheld_in_halls};
