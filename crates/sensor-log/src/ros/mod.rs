//! ROS 2 messages as stored in bags, decoded without a copy where possible.
//!
//! [`RosSchema::named`] finds a message by its type name, [`RosSchema::decode`] decodes its CDR bytes. [`open`](crate::open) does both for the MCAP
//! files of `ros2 bag`; this module is for programs with another source of bytes.

mod camera_info;
mod geometry;
mod header;
mod images;
mod laser_scan;
mod odometry;
mod position;
mod schema;
mod stamped;

pub use crate::cdr::CdrError;
pub use camera_info::CameraInfo;
pub use geometry::{Pose, Twist};
pub use header::Header;
pub use images::{CompressedImage, Image};
pub use laser_scan::LaserScan;
pub use odometry::Odometry;
pub use position::{Imu, NavSatFix};
pub use schema::{RosMessage, RosSchema};
pub use stamped::{PoseStamped, TransformStamped, TwistStamped};
