//! The experiments of Gross, Koenig & Müller in simulated buildings, and those that they leave out, for `wayfix regress cml`.

mod anywhere;
mod area;
mod crowded;
mod follow;
mod four_weeks;
pub(super) mod histogram;
mod lab;
mod setup;
mod step_time;
mod summary;
mod three_days;
mod trip;
mod worlds;

pub use anywhere::{carried_away, carried_on, global_start};
pub use area::laps;
pub use crowded::crowded;
pub use follow::{Course, follow};
pub use four_weeks::four_weeks;
pub use lab::changing_lab;
pub use setup::Setup;
pub use step_time::step_time;
pub use three_days::three_days;
pub use trip::{Trip, TripStep};
