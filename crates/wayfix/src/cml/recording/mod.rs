//! Recordings that are folders of frames with a table of poses, as many who record panoramas keep them.

mod error;
mod frames;
pub(super) mod path;
mod poses;
mod sense;
mod smooth;
mod stamps;
mod table;

pub use error::RecordingError;
pub use frames::{Frame, Recording, RecordingFiles};
pub use path::Heading;
pub use sense::{TurnEvidence, turn_evidence};
pub use smooth::{smoothed, smoothing_of};
