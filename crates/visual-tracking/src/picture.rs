use image::RgbImage;

/// Shares of red, green and blue in the grey value, of 65536. [ITU-R BT.601]
const LUMA: [u32; 3] = [19595, 38470, 7471];

/// The pixels of a picture, row by row from the top left.
pub(crate) fn rgb_pixels(picture: &RgbImage) -> &[[u8; 3]] {
    let n_pixels = picture.width() as usize * picture.height() as usize;
    &picture.as_raw().as_chunks().0[..n_pixels] // the buffer of an image may be longer
}

/// The grey value of every pixel: $`0.299 R + 0.587 G + 0.114 B`$, rounded.
pub(crate) fn grey(picture: &RgbImage) -> Vec<u8> {
    let luma = |pixel: &[u8; 3]| {
        let sum: u32 = pixel.iter().zip(LUMA).map(|(&value, share)| u32::from(value) * share).sum();
        ((sum + 32768) >> 16) as u8
    };
    rgb_pixels(picture).iter().map(luma).collect()
}
