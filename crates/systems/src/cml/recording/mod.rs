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

pub use columns::PoseTableColumns;
pub use error::RecordingError;
pub use frames::{PoseTables, PosedFrame, PosedFrameFolder};
pub use path::HeadingSource;
pub use sense::{AzimuthDirectionEvidence, turn_evidence};
pub use smooth::{smoothed, smoothing_of};
