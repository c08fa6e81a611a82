//! Recordings stored as a folder of frames with a table of poses.

mod columns;
mod error;
mod frames;
pub(super) mod path;
mod poses;
mod sense;
mod smooth;
mod stamps;
mod table;

pub use columns::ColumnNames;
pub use error::RecordingError;
pub use frames::{Frame, Recording, Tables};
pub use path::Heading;
pub use sense::{TurnEvidence, turn_evidence};
pub use smooth::{smoothed, smoothing_of};
