//! The experiments of Gross, Koenig & Müller in simulated buildings, and further ones, for `wayfix-experiments regress cml`.

mod area;
mod crowded;
mod four_weeks;
mod lab;
mod localize_trip;
mod relocalization;
mod setup;
mod step_time;
mod summary;
mod three_days;
mod trip;
mod worlds;

pub use area::laps;
pub use crowded::crowded;
pub use four_weeks::four_weeks;
pub use lab::changing_lab;
pub use localize_trip::{SimulatedDriveResult, localize_trip};
pub use relocalization::{after_relocalization, global_start, kidnapped};
pub use setup::CmlExperimentSetup;
pub use step_time::step_time;
pub use three_days::three_days;
pub use trip::{SimulatedDrive, SimulatedDriveStep};
