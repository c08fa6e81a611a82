//! Recordings as tables: a folder of frames with a table of poses.
//!
//! [`PosedFrameFolder::read`] matches the pictures of a folder with the rows of text tables by index, name or stamp, and counts what does not fit.
//! [`poses`] gives the measured and the smoothed path.

mod columns;
mod error;
mod frames;
mod path;
mod poses;
mod smooth;
mod stamps;
mod table;

pub use columns::PoseTableColumns;
pub use error::RecordingError;
pub use frames::{PoseTables, PosedFrame, PosedFrameFolder};
pub use path::{HeadingSource, poses};
pub use smooth::{smoothed, smoothing_of};
