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

pub(crate) use area::laps;
pub(crate) use crowded::crowded;
pub(crate) use four_weeks::four_weeks;
pub(crate) use lab::changing_lab;
pub(crate) use localize_trip::{SimulatedDriveResult, localize_trip};
pub(crate) use relocalization::{after_relocalization, global_start, kidnapped};
pub(crate) use setup::CmlExperimentSetup;
pub(crate) use step_time::step_time;
pub(crate) use three_days::three_days;
pub(crate) use trip::{SimulatedDrive, SimulatedDriveStep};
