use wayfix_encoded_image::RawPixels;

use super::Header;
use crate::cdr::{CdrError, CdrReader, FromCdr};

/// `sensor_msgs/Image`: pixels as they are.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Image<'a> {
    /// Stamp, and the camera's optical frame.
    pub header: Header<'a>,
    /// Rows.
    pub height: u32,
    /// Columns.
    pub width: u32,
    /// Pixel format: `rgb8`, `mono8`, …
    pub encoding: &'a str,
    /// Whether channels of several bytes have the most significant one first.
    pub is_bigendian: bool,
    /// From one row to the next, bytes.
    pub step: u32,
    /// Rows from the top, each of `step` bytes.
    pub data: &'a [u8],
}

/// `sensor_msgs/CompressedImage`: an image file.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct CompressedImage<'a> {
    /// Stamp, and the camera's optical frame.
    pub header: Header<'a>,
    /// Format name; recorders use many different ones.
    pub format: &'a str,
    /// The file.
    pub data: &'a [u8],
}

impl<'a> Image<'a> {
    /// Its pixels.
    pub(crate) fn pixels(&self) -> RawPixels<'a> {
        let Self { width, height, encoding, step, data, .. } = *self;
        RawPixels { width, height, encoding, step, data }
    }
}

impl<'a> FromCdr<'a> for Image<'a> {
    fn read(cdr: &mut CdrReader<'a>) -> Result<Self, CdrError> {
        Ok(Self {
            header: Header::read(cdr)?,
            height: cdr.u32()?,
            width: cdr.u32()?,
            encoding: cdr.string()?,
            is_bigendian: cdr.u8()? != 0,
            step: cdr.u32()?,
            data: cdr.bytes()?,
        })
    }
}

impl<'a> FromCdr<'a> for CompressedImage<'a> {
    fn read(cdr: &mut CdrReader<'a>) -> Result<Self, CdrError> {
        Ok(Self { header: Header::read(cdr)?, format: cdr.string()?, data: cdr.bytes()? })
    }
}
