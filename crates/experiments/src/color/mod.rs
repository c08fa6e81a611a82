//! The experiments of the paper, and further ones, for `wayfix-experiments regress color`.

mod convergence;
mod frame_time;
mod halls;
mod switching;
mod training;
mod withheld;

pub use convergence::{ConvergenceCount, ConvergenceTrial, global_start, kidnapped};
pub use frame_time::frame_time;
pub use halls::other_halls;
pub use switching::switching;
pub use training::TrainingHalls;
pub use withheld::{withheld, withheld_in_halls};
