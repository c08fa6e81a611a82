//! The experiments of [Andrade-Cetto 2005, Sec. 2.2, Figs. 3-6]: a robot on a line, and the observability of its map.

mod drive;
mod figures;
mod fisher;
mod pictures;
mod reference;

pub(crate) use drive::plain_filter;
pub use drive::{Drive, Step, drive};
pub use figures::{MonteCarlo, monte_carlo};
pub use fisher::{expected_rate, first_entry};
pub use pictures::{fisher_picture, pictures};
pub use reference::{Camera, Reference};
