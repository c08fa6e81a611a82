//! Target tracking in image sequences: the command `wayfix run track`.
//!
//! A [`TrackSystem`] passes the images of a log one by one to the tracker of a [`Method`]. [`TrueBoxes`] holds the true target boxes and
//! [`Score`] the tracking accuracy; [`summarize`] gives the figures and [`pictures`] the pictures. Memory use is independent of the
//! number of frames.
//!
//! ```
//! use wayfix_systems::track::{Score, TrueBoxes};
//! let truth = TrueBoxes::parse("10,10,20,20\n11,10,20,20\n0,0,0,0\n")?;
//! let mut score = Score::default();
//! for (index, estimate) in [(0, truth.at(0).target()), (1, None)] {
//!     score.add(estimate.as_ref(), &truth.at(index).target().expect("in sight"));
//! }
//! assert_eq!(score.iou_mean(), Some(0.5)); // the second frame was lost
//! assert!(truth.at(2).is_absent() && truth.at(3).is_unknown());
//! # Ok::<(), wayfix_systems::track::TrackError>(())
//! ```

mod error;
mod figures;
mod frame_tracker;
mod method;
mod output;
mod params;
mod run;
mod score;
mod start;
mod status_score;
mod system;
mod truth;

pub use error::TrackError;
pub use figures::summarize;
pub use frame_tracker::{FrameTracker, TargetColors};
pub use method::Method;
pub use output::estimates::TrackLog;
pub use output::pictures::pictures;
pub use output::run_history::RunHistory;
pub use params::TrackParams;
pub use run::{TrackRun, run};
pub use score::Score;
pub use start::Start;
pub use status_score::StatusScore;
pub use system::{FrameResult, TrackSetup, TrackSystem};
pub use truth::{TrueBoxes, Truth, parse_box};
