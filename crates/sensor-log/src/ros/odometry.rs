use super::geometry::pass_over_covariance;
use super::{Header, Pose, Twist};
use crate::cdr::{CdrError, CdrReader, FromCdr};

/// `nav_msgs/Odometry`, without its covariances.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Odometry<'a> {
    /// Stamp, and the frame of the pose, which drifts.
    pub header: Header<'a>,
    /// The robot's frame.
    pub child_frame_id: &'a str,
    /// The robot's frame in that of the header.
    pub pose: Pose,
    /// Velocity in the robot's frame.
    pub twist: Twist,
}

impl<'a> FromCdr<'a> for Odometry<'a> {
    fn read(cdr: &mut CdrReader<'a>) -> Result<Self, CdrError> {
        let (header, child_frame_id) = (Header::read(cdr)?, cdr.string()?);
        let pose = Pose::read(cdr)?;
        pass_over_covariance(cdr)?;
        let twist = Twist::read(cdr)?;
        pass_over_covariance(cdr)?;
        Ok(Self { header, child_frame_id, pose, twist })
    }
}
