use crate::{EncodedImage, ImageError, ImageFileFormat};

/// The image in a message of ROS 2 or Foxglove that contains an image file, with the sender's name of the format.
///
/// The file content takes precedence over the name. Depth images and the mosaic of a Bayer sensor are rejected, even in a JPEG or PNG file.
/// `image_transport` names the pixels, the compression and the compressed pixels: `bayer_rggb8; jpeg compressed bgr8`.
///
/// # Errors
/// Returns an error if the message holds no picture.
pub fn compressed_message(called: &str, bytes: &[u8]) -> Result<EncodedImage, ImageError> {
    let refused = |why| Err(ImageError::NoPicture { called: shortened(called), why, n_bytes: bytes.len() });
    let pixels = called.split(';').next().unwrap_or_default().trim();
    if DEPTH.contains(&pixels) || called.contains("compressedDepth") {
        return refused("holds distances, which are no picture");
    }
    let Some(format) = ImageFileFormat::of_bytes(bytes) else {
        return refused("is neither JPEG nor PNG");
    };
    let image = EncodedImage::new(format, bytes);
    if pixels.starts_with("bayer_") && !(is_made_colour(called) && n_channels(&image) >= 3) {
        return refused("is the mosaic of a Bayer sensor; record the debayered images");
    }
    let is_deep_grey = format == ImageFileFormat::Png
        && image.layout().is_ok_and(|layout| layout.bits_per_channel > 8 && layout.channels <= 2);
    if is_deep_grey {
        return refused("has 16 bits of grey, which are distances or raw values");
    }
    Ok(image)
}

/// The encodings of distances in `sensor_msgs/image_encodings.hpp` and their relatives. [REP 118]
const DEPTH: [&str; 5] = ["16UC1", "16SC1", "32SC1", "32FC1", "64FC1"];

/// Enough of a name to recognize it in an error.
pub(crate) fn shortened(name: &str) -> String {
    const MAX_CHARS: usize = 40;
    match name.char_indices().nth(MAX_CHARS) {
        Some((end, _)) => format!("{}…", &name[..end]),
        None => name.to_owned(),
    }
}

/// Whether the name says that the sender converted the mosaic to colour before compression.
fn is_made_colour(called: &str) -> bool {
    ["bgr8", "rgb8"].iter().any(|colours| called.trim_end().ends_with(colours))
}

fn n_channels(image: &EncodedImage) -> u8 {
    image.layout().map_or(0, |layout| layout.channels)
}

#[cfg(test)]
mod tests {
    use super::*;

    fn reason(called: &str, bytes: &[u8]) -> String {
        compressed_message(called, bytes).unwrap_err().to_string()
    }

    #[test]
    fn compressed_mosaic_and_depth_are_refused_by_name() {
        let grey = EncodedImage::png_gray(4, 2, &[7; 8]).unwrap();
        let colour = EncodedImage::jpeg(4, 2, &[7; 24], 90).unwrap();
        assert!(reason("bayer_rggb8; jpeg compressed ", &grey.bytes).contains("Bayer"));
        assert!(reason("bayer_gbrg16; png compressed", &colour.bytes).contains("Bayer"));
        assert!(reason("bayer_rggb8; jpeg compressed bgr8", &grey.bytes).contains("Bayer"));
        assert!(compressed_message("bayer_rggb8; jpeg compressed bgr8", &colour.bytes).is_ok());
        for called in ["16UC1; compressedDepth png", "32FC1; compressedDepth", "16UC1; png compressed "] {
            assert!(reason(called, &grey.bytes).contains("distances"), "{called}");
        }
        for called in ["png", "mono8; png compressed mono8", ""] {
            assert_eq!(compressed_message(called, &grey.bytes).unwrap(), grey, "{called}");
        }
        assert!(reason("jpeg", b"GIF89a").contains("neither JPEG nor PNG"));
    }

    #[test]
    fn a_png_of_16_grey_bits_is_refused_whatever_its_name() {
        let deep = image::ImageBuffer::from_pixel(3, 2, image::Luma([3_000_u16]));
        let mut bytes = std::io::Cursor::new(Vec::new());
        image::DynamicImage::from(deep).write_to(&mut bytes, image::ImageFormat::Png).unwrap();
        assert!(reason("png", bytes.get_ref()).contains("16 bits of grey"));
    }
}
