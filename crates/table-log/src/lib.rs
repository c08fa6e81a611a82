//! Recordings as tables: a folder of frames with a table of poses.
//!
//! [`PosedFrameFolder::read`] matches the pictures of a folder with the rows of text tables by index, name or stamp, and counts what does not fit.
//! [`MovedFrameFolder::read`] does so for moves on a grid of places. [`poses`] gives the measured and the smoothed path.
//! [`RangeRecording::read`] reads ranges to radio beacons.

mod columns;
mod error;
mod frames;
mod moves;
mod path;
mod poses;
mod ranges;
mod smooth;
mod stamps;
mod table;

pub use columns::PoseTableColumns;
pub use error::RecordingError;
pub use frames::{PoseTables, PosedFrame, PosedFrameFolder};
pub use moves::{MOVE_TABLE, MoveRow, MoveTable, MovedFrame, MovedFrameFolder};
pub use path::{HeadingSource, poses};
pub use ranges::{BeaconRangeRow, RangeRecording};
pub use smooth::{smoothed, smoothing_of};
