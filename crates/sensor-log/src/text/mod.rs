//! Line-based formats.

mod clock_faults;
mod gps;
mod half_circle;
mod lines;
mod relations;
mod row;
mod scan_odometry;
mod time_order;

pub(crate) mod carmen;
pub(crate) mod range_bearing;
pub(crate) mod range_bearing_writer;
pub(crate) mod scan_json;
pub(crate) mod tum;
pub(crate) mod utias;
pub(crate) mod victoria_park;

pub(crate) use lines::Lines;
pub use relations::{PoseRelation, read_relations};
