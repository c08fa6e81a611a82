use crate::ColorId;

/// A run of pixels in one row whose centres show one colour: columns `start..end`, never empty.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub struct PixelSpan {
    /// Row of the image, 0 at the top.
    pub row: u16,
    /// First column.
    pub start: u16,
    /// One past the last column.
    pub end: u16,
    /// Colour of the pixels.
    pub color: ColorId,
}
