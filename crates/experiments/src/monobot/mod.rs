//! The experiments of [Andrade-Cetto 2005, Sec. 2.2, Figs. 3–6]: a robot on a line, and the observability of its map.

mod drive;
mod figures;
mod fisher;
mod plots;
mod reference;

pub(crate) use drive::plain_filter;
pub use drive::{MonobotDrive, MonobotStep, drive};
pub use figures::{MonobotMonteCarlo, monte_carlo};
pub use fisher::{expected_rate, first_entry};
pub use plots::{fisher_plot, plots};
pub use reference::{FixedPositionSensor, WorldReference};
