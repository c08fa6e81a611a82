//! Figures of a trajectory and a map against truth, as `docs/accuracy.md` defines them.

mod alignment;
mod interval;
mod landmarks;
mod positions;
mod relative;
mod trajectory;
mod truth;
mod truth_noise;

pub use alignment::{align, median_distance, rms_distance};
pub use interval::{MeanInterval, proportion_interval};
pub use landmarks::{LandmarkCorrespondence, landmark_errors};
pub use positions::TruePositions;
pub use relative::{RelativeErrors, relative_errors};
pub use trajectory::{PoseWithTruth, TrajectoryErrors, trajectory_errors};
pub use truth::LONGEST_GAP;
pub use truth::ReferencePath;
