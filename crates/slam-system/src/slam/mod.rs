//! SLAM on a log: records → trajectory, map, figures, pictures, MCAP.
//!
//! [`SlamSystem`] is generic over a [`FrontEnd`]: [`points`](crate::points) for range-bearing detections, [`walls`](crate::walls) for laser scans.
//! Filter, association, observability, saved maps, figures and pictures are the same for both. `examples/01_custom_landmark.rs` adds a third kind of landmark. A smoother may follow the filter: it takes the
//! motions and pairings, and gives the estimates or the optimum to compare with.

mod association;
mod estimates;
mod estimator;
mod external;
mod figures;
mod follower;
mod front_end;
mod parameter_numbers;
mod plots;
mod run;
mod saved;
mod start;
mod system;

pub use association::AssociationRule;
pub use estimates::{SlamDrawingState, SlamEstimateRecorder};
pub use estimator::{SlamEstimator, StampedEstimate, nis};
pub use external::ExternalState;
pub(crate) use figures::{path_metrics, summary, timings};
pub(crate) use follower::{MAX_BATCH_POSES, NO_BATCH, SlamFollower, carried};
pub use follower::{SmoothedRun, Smoothing};
pub use front_end::{FrontEnd, FrontEndState, MotionEstimate};
pub(crate) use parameter_numbers::{increment_numbers, number};
pub(crate) use plots::{path_plots, plots_with};
pub use run::SlamRun;
pub(crate) use saved::check_association;
pub use saved::{PeriodicStateSaver, SavedMapError, SlamState};
pub(crate) use start::{start_pose, warn_of_an_empty_map, warn_of_gross_errors};
pub(crate) use system::FIRST_ANCHOR;
pub use system::{SlamSystem, StateOf};
