//! Target tracking in image sequences: the command `wayfix run track`.
//!
//! A [`TrackSystem`] passes the images of a log one by one to the tracker of a [`TrackingMethod`]. [`TrueBoxes`] holds the true target boxes and
//! [`BoxScore`] the tracking accuracy; [`summarize`] gives the figures and [`plots`] the pictures. Memory use is independent of the
//! number of frames.
//!
//! ```
//! use wayfix_systems::track::{BoxScore, TargetTruth, TrueBoxes};
//! let truth = TrueBoxes::parse("10,10,20,20\n11,10,20,20\n0,0,0,0\n")?;
//! let mut score = BoxScore::default();
//! for (index, estimate) in [(0, truth.at(0).target()), (1, None)] {
//!     score.add(estimate.as_ref(), &truth.at(index).target().expect("in sight"));
//! }
//! assert_eq!(score.iou_mean(), Some(0.5)); // the second frame was lost
//! assert_eq!((truth.at(2), truth.at(3)), (TargetTruth::Absent, TargetTruth::Unknown));
//! # Ok::<(), wayfix_systems::track::TrackSystemError>(())
//! ```

mod error;
mod figures;
mod frame_tracker;
mod frozen_film;
mod learn_head;
mod method;
mod output;
mod params;
mod run;
mod score;
mod start;
mod status_score;
mod system;
mod truth;

pub use error::TrackSystemError;
pub use figures::summarize;
pub use frame_tracker::{FrameTracker, TargetColorDistribution};
pub use learn_head::learn_head;
pub use method::TrackingMethod;
pub use output::estimates::TrackEstimateRecorder;
pub use output::plots::plots;
pub use output::run_history::TrackRunHistory;
pub use params::TrackParams;
pub use run::{TrackRun, run};
pub use score::BoxScore;
pub use start::InitialTargetRegion;
pub use status_score::LostStatusScore;
pub use system::{TrackFrameResult, TrackSystem, TrackerConfig};
pub use truth::{TargetTruth, TrueBoxes, parse_box};
