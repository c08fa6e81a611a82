//! Pose graphs in the text format of g2o: read, start, optimize, write.
//!
//! | line | meaning |
//! | --- | --- |
//! | `VERTEX_SE2 id x y θ`, `VERTEX_SE3:QUAT id x y z qx qy qz qw` | a pose, metres and radians |
//! | `VERTEX_XY id x y`, `VERTEX_TRACKXYZ id x y z` | a landmark, metres |
//! | `EDGE_SE2 i j x y θ I…`, `EDGE_SE3:QUAT i j x y z qx qy qz qw I…` | pose j as seen from i; upper triangle of the information by rows |
//! | `EDGE_SE2_XY i j x y I…`, `EDGE_SE3_TRACKXYZ i j sensor x y z I…` | landmark j as seen from pose i |
//! | `PARAMS_SE3OFFSET sensor x y z qx qy qz qw` | a sensor on the robot |
//! | `FIX id…` | vertices that stay |
//!
//! Blank lines and lines that begin with `#` are passed over; any other line is an error. Without `FIX` the first pose stays.
//! Without any `VERTEX` line poses start from dead reckoning.
//!
//! ```
//! use wayfix_smoother::{Params, g2o::{self, G2o}};
//! let text = "EDGE_SE2 0 1 1 0 0 1 0 0 1 0 1\nEDGE_SE2 1 2 1 0 0 1 0 0 1 0 1\nEDGE_SE2 0 2 2.3 0 0 1 0 0 1 0 1\n";
//! let G2o::Planar(mut poses) = g2o::read(text.as_bytes())? else { unreachable!() };
//! let mut problem = poses.problem(g2o::Repair::Refuse)?;
//! problem.start_linearly(&poses)?;
//! let summary = problem.graph.optimize(&Params::default())?;
//! problem.store(&mut poses)?;
//! assert!((summary.cost - 0.03).abs() < 1e-9 && (poses.poses[2].1.x() - 2.2).abs() < 1e-6);
//! # Ok::<(), g2o::G2oError>(())
//! ```

mod dead_reckoning;
mod error;
mod linear_start;
mod parse;
mod pose_graph;
mod problem;
mod read;
mod rigid_pose;
mod write;

pub use error::{G2oError, LineProblem};
pub use pose_graph::{Edge, G2o, PointEdge, PoseGraph};
pub use problem::{Problem, Repair};
pub use read::read;
pub use rigid_pose::RigidPose;
