//! Figures of a trajectory and a map against truth, as `docs/accuracy.md` defines them.

mod alignment;
mod interval;
mod landmarks;
mod positions;
mod start;
mod trajectory;
mod truth;

pub use alignment::{align, median_distance, rms_distance};
pub use interval::{MeanInterval, proportion_interval};
pub use landmarks::{Correspondence, landmark_errors};
pub use positions::TruePositions;
pub use start::KnownStart;
pub use trajectory::{Sample, TrajectoryErrors, trajectory_errors};
pub(crate) use truth::LONGEST_GAP;
pub use truth::TrueTrack;
