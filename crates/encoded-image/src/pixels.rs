use crate::message::shortened;
use crate::{EncodedImage, ImageError};

/// Pixels as messages have them, of ROS 2 and of Foxglove.
#[derive(Clone, Copy, Debug)]
pub struct RawPixels<'a> {
    /// Columns.
    pub width: u32,
    /// Rows.
    pub height: u32,
    /// Pixel format: `rgb8`, `mono8`, …
    pub encoding: &'a str,
    /// From one row to the next, bytes.
    pub step: u32,
    /// Rows from the top.
    pub data: &'a [u8],
}

impl RawPixels<'_> {
    /// Converts the image to an uncompressed file.
    ///
    /// Removes row padding and transparency; colours are in the order R, G, B.
    ///
    /// # Errors
    /// Returns an error if the encoding is not read or the rows do not fit into the bytes.
    pub fn uncompressed(&self) -> Result<EncodedImage, ImageError> {
        let Self { width, height, encoding, step, data } = *self;
        let channels = channels(encoding)?;
        let row_bytes = u64::from(width) * channels.n_bytes as u64;
        // The last row may lack padding.
        let rows_before = u64::from(step) * u64::from(height.saturating_sub(1));
        let needed = rows_before.saturating_add(row_bytes);
        if u64::from(step) < row_bytes || (data.len() as u64) < needed {
            let (encoding, n_bytes) = (encoding.to_owned(), data.len());
            return Err(ImageError::Rows { width, height, encoding, step, n_bytes });
        }
        let rows =
            data.chunks(step.max(1) as usize).take(height as usize).map(|row| &row[..row_bytes as usize]);
        let pixels = rows.flat_map(|row| row.chunks_exact(channels.n_bytes));
        match channels.colors {
            None => EncodedImage::pnm_gray(width, height, &pixels.flatten().copied().collect::<Vec<u8>>()),
            Some(order) => {
                let rgb: Vec<u8> = pixels.flat_map(|pixel| order.map(|channel| pixel[channel])).collect();
                EncodedImage::pnm_rgb(width, height, &rgb)
            }
        }
    }
}

/// Offsets of the channels in a pixel.
struct Channels {
    n_bytes: usize,
    /// Of red, green and blue; `None` for grey.
    colors: Option<[usize; 3]>,
}

/// Names as in `sensor_msgs/image_encodings.hpp`; OpenCV types without a colour order count as blue first.
fn channels(encoding: &str) -> Result<Channels, ImageError> {
    let (n_bytes, colors) = match encoding {
        "mono8" | "8UC1" => (1, None),
        "rgb8" => (3, Some([0, 1, 2])),
        "bgr8" | "8UC3" => (3, Some([2, 1, 0])),
        "rgba8" => (4, Some([0, 1, 2])),
        "bgra8" | "8UC4" => (4, Some([2, 1, 0])),
        other => return Err(ImageError::Encoding { encoding: shortened(other) }),
    };
    Ok(Channels { n_bytes, colors })
}

#[cfg(test)]
mod tests {
    use super::*;

    fn square<'a>(encoding: &'a str, step: u32, data: &'a [u8]) -> RawPixels<'a> {
        RawPixels { width: 2, height: 2, encoding, step, data }
    }

    #[test]
    fn every_order_of_colours_becomes_the_same_picture() {
        let rgb = [1, 2, 3, 4, 5, 6, 7, 8, 9, 10, 11, 12];
        let bgr = [3, 2, 1, 6, 5, 4, 9, 8, 7, 12, 11, 10];
        let rgba = [1, 2, 3, 0, 4, 5, 6, 0, 7, 8, 9, 0, 10, 11, 12, 0];
        let bgra = [3, 2, 1, 9, 6, 5, 4, 9, 9, 8, 7, 9, 12, 11, 10, 9];
        let cases: [(&str, u32, &[u8]); 5] = [
            ("rgb8", 6, &rgb),
            ("bgr8", 6, &bgr),
            ("8UC3", 6, &bgr),
            ("rgba8", 8, &rgba),
            ("bgra8", 8, &bgra),
        ];
        for (encoding, step, data) in cases {
            let pixels = square(encoding, step, data).uncompressed().unwrap().decode_rgb().unwrap().pixels;
            assert_eq!(pixels, rgb, "{encoding}");
        }
    }

    #[test]
    fn padding_is_dropped_and_may_be_missing_behind_the_last_row() {
        for data in [&[1, 2, 99, 3, 4, 99][..], &[1, 2, 99, 3, 4]] {
            let pixels = square("mono8", 3, data).uncompressed().unwrap().decode_gray().unwrap().pixels;
            assert_eq!(pixels, [1, 2, 3, 4]);
        }
    }

    #[test]
    fn sizes_that_do_not_fit_and_unknown_pixels_are_refused() {
        for (encoding, step, n_bytes) in
            [("mono8", 1, 9), ("mono8", 3, 4), ("rgb8", 6, 11), ("16UC1", 4, 8), ("mono8", u32::MAX, 9)]
        {
            assert!(square(encoding, step, &vec![0; n_bytes]).uncompressed().is_err(), "{encoding} {step}");
        }
        let huge = RawPixels { width: u32::MAX, height: u32::MAX, ..square("rgba8", u32::MAX, &[0; 9]) };
        assert!(huge.uncompressed().is_err());
        let nothing = RawPixels { width: 0, height: 0, ..square("rgb8", 0, &[]) };
        assert!(nothing.uncompressed().is_err());
    }
}
