use super::Header;
use crate::cdr::{CdrError, CdrReader, FromCdr};

/// `sensor_msgs/CameraInfo`: how a camera projects. The centre of the first pixel is at (0, 0).
#[derive(Clone, Debug, PartialEq)]
pub struct CameraInfo<'a> {
    /// Stamp, and the camera's optical frame.
    pub header: Header<'a>,
    /// Rows of the whole sensor.
    pub height: u32,
    /// Columns of the whole sensor.
    pub width: u32,
    /// Distortion model of `d`: `plumb_bob`, …
    pub distortion_model: &'a str,
    /// Distortion.
    pub d: Vec<f64>,
    /// Intrinsic matrix of the images as they are, row by row, pixels.
    pub k: [f64; 9],
    /// Rotation into the rectified images, row by row.
    pub r: [f64; 9],
    /// Projection of the rectified images, row by row, pixels.
    pub p: [f64; 12],
    /// Number of sensor columns and rows per image pixel; 0 means 1.
    pub binning: [u32; 2],
    /// Part of the sensor that the images show: first column, first row, columns, rows; all 0 for the whole.
    pub region: [u32; 4],
}

impl<'a> FromCdr<'a> for CameraInfo<'a> {
    fn read(cdr: &mut CdrReader<'a>) -> Result<Self, CdrError> {
        let header = Header::read(cdr)?;
        let (height, width) = (cdr.u32()?, cdr.u32()?);
        let (distortion_model, d) = (cdr.string()?, cdr.f64s()?);
        let (k, r, p) = (cdr.f64_array()?, cdr.f64_array()?, cdr.f64_array()?);
        let binning = [cdr.u32()?, cdr.u32()?];
        let (x_offset, y_offset, region_height, region_width) =
            (cdr.u32()?, cdr.u32()?, cdr.u32()?, cdr.u32()?);
        let _do_rectify = cdr.u8()?;
        let region = [x_offset, y_offset, region_width, region_height];
        Ok(Self { header, height, width, distortion_model, d, k, r, p, binning, region })
    }
}
