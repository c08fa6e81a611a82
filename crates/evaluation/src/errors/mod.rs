//! Figures of a trajectory and a map against truth, as `docs/accuracy.md` defines them.

mod alignment;
mod interval;
mod landmarks;
mod positions;
mod relative;
mod running_errors;
mod stamped_truth;
mod trajectory;
mod truth;
mod truth_noise;
mod truth_queue;

pub use alignment::{align, median_distance, rms_distance};
pub use interval::{MeanInterval, proportion_interval};
pub use landmarks::{LandmarkCorrespondence, landmark_errors};
pub use positions::TruePositions;
pub use relative::{RelativeErrors, relative_errors};
pub use running_errors::RunningErrors;
pub use trajectory::{PoseWithTruth, TrajectoryErrors, trajectory_errors};
pub use truth::LONGEST_GAP;
pub use truth::ReferencePath;
pub use truth_queue::TruthQueue;
