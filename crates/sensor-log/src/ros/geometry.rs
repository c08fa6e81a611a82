use crate::cdr::{CdrError, CdrReader, FromCdr};

/// `geometry_msgs/Pose`, and `Transform`, which is the same.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Pose {
    /// x, y, z, metres.
    pub position: [f64; 3],
    /// x, y, z, w.
    pub orientation: [f64; 4],
}

/// `geometry_msgs/Twist`.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Twist {
    /// x, y, z, m/s.
    pub linear: [f64; 3],
    /// About x, y, z, rad/s.
    pub angular: [f64; 3],
}

impl<'a> FromCdr<'a> for Pose {
    fn read(cdr: &mut CdrReader<'a>) -> Result<Self, CdrError> {
        Ok(Self { position: cdr.f64_array()?, orientation: cdr.f64_array()? })
    }
}

impl<'a> FromCdr<'a> for Twist {
    fn read(cdr: &mut CdrReader<'a>) -> Result<Self, CdrError> {
        Ok(Self { linear: cdr.f64_array()?, angular: cdr.f64_array()? })
    }
}

/// The covariance of `(x, y, θ)`, row by row, of the six coordinates of a pose.
pub(super) fn planar_covariance(cdr: &mut CdrReader<'_>) -> Result<[f64; 9], CdrError> {
    let all: [f64; 36] = cdr.f64_array()?;
    Ok([0, 1, 5, 6, 7, 11, 30, 31, 35].map(|index| all[index]))
}

/// Passes over the covariance of a pose or a twist.
pub(super) fn pass_over_covariance(cdr: &mut CdrReader<'_>) -> Result<(), CdrError> {
    cdr.f64_array::<36>().map(drop)
}
