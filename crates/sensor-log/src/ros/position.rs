use super::Header;
use crate::cdr::{CdrError, CdrReader, FromCdr};

/// `sensor_msgs/NavSatFix`: a fix of a satellite receiver, in WGS 84.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct NavSatFix<'a> {
    /// Stamp, and the frame of the antenna.
    pub header: Header<'a>,
    /// Negative without a fix.
    pub status: i8,
    /// Degrees.
    pub latitude: f64,
    /// Degrees.
    pub longitude: f64,
    /// Of east, north and up, m², row by row.
    pub covariance: [f64; 9],
    /// 0 if the covariance is unknown.
    pub covariance_type: u8,
}

/// `sensor_msgs/Imu`: its orientation alone.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Imu<'a> {
    /// Stamp, and the frame of the IMU.
    pub header: Header<'a>,
    /// x, y, z, w; against east, north and up.
    pub orientation: [f64; 4],
    /// About x, y and z, rad², row by row; begins with −1 without an orientation.
    pub covariance: [f64; 9],
}

impl<'a> FromCdr<'a> for NavSatFix<'a> {
    fn read(cdr: &mut CdrReader<'a>) -> Result<Self, CdrError> {
        let (header, status) = (Header::read(cdr)?, cdr.u8()?.cast_signed());
        cdr.u16()?; // the service
        let [latitude, longitude, _] = cdr.f64_array()?;
        let covariance = cdr.f64_array()?;
        Ok(Self { header, status, latitude, longitude, covariance, covariance_type: cdr.u8()? })
    }
}

impl<'a> FromCdr<'a> for Imu<'a> {
    fn read(cdr: &mut CdrReader<'a>) -> Result<Self, CdrError> {
        Ok(Self { header: Header::read(cdr)?, orientation: cdr.f64_array()?, covariance: cdr.f64_array()? })
    }
}
