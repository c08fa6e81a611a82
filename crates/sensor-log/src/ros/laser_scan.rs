use super::Header;
use crate::cdr::{CdrError, CdrReader, FromCdr};

/// `sensor_msgs/LaserScan`.
#[derive(Clone, Debug, PartialEq)]
pub struct LaserScan<'a> {
    /// Stamp of the first beam, and the laser's frame: angles are about its z axis, from its x axis.
    pub header: Header<'a>,
    /// Direction of the first beam, radians.
    pub angle_min: f32,
    /// Direction of the last beam, radians.
    pub angle_max: f32,
    /// From one beam to the next, radians.
    pub angle_increment: f32,
    /// From one beam to the next, seconds.
    pub time_increment: f32,
    /// From one scan to the next, seconds.
    pub scan_time: f32,
    /// Shorter ranges are no echo, metres.
    pub range_min: f32,
    /// Longer ranges are no echo, metres.
    pub range_max: f32,
    /// Metres.
    pub ranges: Vec<f32>,
    /// In units of the device; empty where it measures none.
    pub intensities: Vec<f32>,
}

impl<'a> FromCdr<'a> for LaserScan<'a> {
    fn read(cdr: &mut CdrReader<'a>) -> Result<Self, CdrError> {
        Ok(Self {
            header: Header::read(cdr)?,
            angle_min: cdr.f32()?,
            angle_max: cdr.f32()?,
            angle_increment: cdr.f32()?,
            time_increment: cdr.f32()?,
            scan_time: cdr.f32()?,
            range_min: cdr.f32()?,
            range_max: cdr.f32()?,
            ranges: cdr.f32s()?,
            intensities: cdr.f32s()?,
        })
    }
}
