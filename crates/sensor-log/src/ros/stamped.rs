use super::geometry::planar_covariance;
use super::{Header, Pose, Twist};
use crate::cdr::{CdrError, CdrReader, FromCdr};

/// `geometry_msgs/PoseStamped`, or `PoseWithCovarianceStamped`.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct PoseStamped<'a> {
    /// Stamp, and the frame of the pose.
    pub header: Header<'a>,
    /// The pose.
    pub pose: Pose,
    /// Of `(x, y, θ)`, m and rad, row by row, where the message has one.
    pub covariance: Option<[f64; 9]>,
}

/// `geometry_msgs/TwistStamped`, or a bare `Twist`.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct TwistStamped<'a> {
    /// Stamp, and the frame of the velocity; a bare twist has neither.
    pub header: Option<Header<'a>>,
    /// The velocity.
    pub twist: Twist,
}

/// `geometry_msgs/TransformStamped`: pose of one frame in another.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct TransformStamped<'a> {
    /// Stamp and parent frame.
    pub header: Header<'a>,
    /// The frame that is placed.
    pub child_frame_id: &'a str,
    /// The child in the parent.
    pub transform: Pose,
}

impl<'a> FromCdr<'a> for PoseStamped<'a> {
    fn read(cdr: &mut CdrReader<'a>) -> Result<Self, CdrError> {
        Ok(Self { header: Header::read(cdr)?, pose: Pose::read(cdr)?, covariance: None })
    }
}

impl<'a> PoseStamped<'a> {
    /// The message that has a covariance behind the pose.
    pub(super) fn read_with_covariance(cdr: &mut CdrReader<'a>) -> Result<Self, CdrError> {
        let stamped = Self::read(cdr)?;
        Ok(Self { covariance: Some(planar_covariance(cdr)?), ..stamped })
    }
}

impl<'a> FromCdr<'a> for TwistStamped<'a> {
    fn read(cdr: &mut CdrReader<'a>) -> Result<Self, CdrError> {
        Ok(Self { header: Some(Header::read(cdr)?), twist: Twist::read(cdr)? })
    }
}

impl<'a> FromCdr<'a> for TransformStamped<'a> {
    fn read(cdr: &mut CdrReader<'a>) -> Result<Self, CdrError> {
        Ok(Self { header: Header::read(cdr)?, child_frame_id: cdr.string()?, transform: Pose::read(cdr)? })
    }
}
