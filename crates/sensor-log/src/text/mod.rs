//! Line-based formats.

mod gps;
mod lines;
mod row;
mod time_check;

pub(crate) mod range_bearing;
pub(crate) mod range_bearing_writer;
pub(crate) mod tum;
pub(crate) mod utias;
pub(crate) mod victoria_park;

pub(crate) use lines::Lines;
