//! The experiments of [Andrade-Cetto 2005, Sec. 2.2, Figs. 3–6]: a robot on a line, and the observability of its map.

mod drive;
mod figures;
mod fisher;
mod likelihood;
mod plots;
mod reference;

pub(crate) use drive::{MonobotDrive, MonobotStep, drive, plain_filter};
pub(crate) use figures::monte_carlo;
pub use fisher::expected_rate;
pub(crate) use fisher::first_entry;
pub(crate) use likelihood::likelihood_metrics;
pub(crate) use plots::{fisher_plot, plots};
pub(crate) use reference::{FixedPositionSensor, WorldReference};
