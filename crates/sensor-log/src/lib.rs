//! Stamped robot records: readers for public data sets and MCAP, writer for MCAP.

mod record;
mod stamp;

pub use record::{Data, Record, Sighting, Target, TrueLandmark, Velocity};
pub use stamp::Stamp;
