//! Messages of ROS 2 as they lie in bags, decoded without a copy where that is possible.
//!
//! [`RosSchema::named`] knows a message by the name of its type, [`RosSchema::decode`] reads its CDR bytes. [`open`](crate::open) does both for
//! the MCAP files that `ros2 bag` writes; here it is for programs that get the bytes elsewhere.

mod camera_info;
mod geometry;
mod header;
mod images;
mod laser_scan;
mod odometry;
mod schema;
mod stamped;

pub use crate::cdr::CdrError;
pub use camera_info::CameraInfo;
pub use geometry::{Pose, Twist};
pub use header::Header;
pub use images::{CompressedImage, Image};
pub use laser_scan::LaserScan;
pub use odometry::Odometry;
pub use schema::{RosMessage, RosSchema};
pub use stamped::{PoseStamped, TransformStamped, TwistStamped};
