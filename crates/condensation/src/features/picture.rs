//! What a picture needs to be learned: its pixels, its grey values, and itself in another light or shifted.

use image::{GrayImage, RgbImage};

/// Shares of red, green and blue in the grey value, of 65536. [ITU-R BT.601]
const LUMA: [u32; 3] = [19595, 38470, 7471];

/// Width and height of a picture.
pub(crate) fn size(picture: &RgbImage) -> (usize, usize) {
    (picture.width() as usize, picture.height() as usize)
}

/// The pixels of a picture, row by row from the top left.
pub(crate) fn rgb_pixels(picture: &RgbImage) -> &[[u8; 3]] {
    let (width, height) = size(picture);
    &picture.as_raw().as_chunks().0[..width * height] // the buffer of an image may be longer
}

/// The grey value of every pixel: $`0.299 R + 0.587 G + 0.114 B`$, rounded.
///
/// ```
/// use wayfix_condensation::{RgbImage, grey};
/// let picture = RgbImage::from_raw(2, 1, vec![255, 255, 255, 10, 20, 30]).expect("3 bytes a pixel");
/// assert_eq!(grey(&picture).as_raw(), &[255, 18]);
/// ```
pub fn grey(picture: &RgbImage) -> GrayImage {
    let luma = |pixel: &[u8; 3]| {
        let sum: u32 = pixel.iter().zip(LUMA).map(|(&value, share)| u32::from(value) * share).sum();
        ((sum + 32768) >> 16) as u8
    };
    let values = rgb_pixels(picture).iter().map(luma).collect();
    GrayImage::from_raw(picture.width(), picture.height(), values).expect("invariant: one value a pixel")
}

/// The picture with every channel sent through its own table.
pub fn mapped(picture: &RgbImage, tables: &[[u8; 256]; 3]) -> RgbImage {
    let mut mapped = picture.clone();
    for pixel in mapped.pixels_mut() {
        pixel.0 = [0, 1, 2].map(|c| tables[c][usize::from(pixel[c])]);
    }
    mapped
}

/// The picture of a camera moved right by `dx` and down by `dy` pixels: `(x, y)` shows what was at `(x + dx, y + dy)`. Beyond the edge
/// the last pixel repeats.
pub fn shifted(picture: &RgbImage, dx: i32, dy: i32) -> RgbImage {
    let at = |i: u32, by: i32, len: u32| i.saturating_add_signed(by).min(len - 1);
    let (width, height) = picture.dimensions();
    RgbImage::from_fn(width, height, |x, y| *picture.get_pixel(at(x, dx, width), at(y, dy, height)))
}
