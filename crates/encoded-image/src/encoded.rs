use std::fmt;
use std::sync::Arc;

/// An image file. Clones share the bytes.
///
/// ```
/// use wayfix_encoded_image::EncodedImage;
/// let grey = [0_u8, 50, 100, 150, 200, 250];
/// let image = EncodedImage::png_gray(3, 2, &grey)?;
/// assert_eq!(image.decode_gray()?.pixels, grey);
/// let colours = image.decode_rgb()?;
/// assert_eq!((colours.width, colours.height, &colours.pixels[3..6]), (3, 2, &[50, 50, 50][..]));
/// # Ok::<(), wayfix_encoded_image::ImageError>(())
/// ```
#[derive(Clone, PartialEq, Eq)]
pub struct EncodedImage {
    /// Storage format.
    pub format: ImageFileFormat,
    /// The file.
    pub bytes: Arc<[u8]>,
}

/// Storage format of an image.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash, PartialOrd, Ord)]
#[non_exhaustive]
pub enum ImageFileFormat {
    /// JPEG, with loss.
    Jpeg,
    /// PNG, without.
    Png,
    /// Not compressed: a portable anymap, grey (`P5`) or in colour (`P6`), of eight bits a channel.
    Pnm,
}

/// An image as pixels.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct DecodedImage {
    /// Columns.
    pub width: u32,
    /// Rows.
    pub height: u32,
    /// Row by row from the upper left: three bytes a pixel (R, G, B), or one of a grey image.
    pub pixels: Vec<u8>,
}

/// Pixel layout of a file.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct PixelLayout {
    /// 1 grey, 2 grey and alpha, 3 colours, 4 colours and alpha.
    pub channels: u8,
    /// Bits of each channel.
    pub bits_per_channel: u16,
}

impl PixelLayout {
    /// Whether the pixels have an alpha channel.
    pub fn has_alpha(self) -> bool {
        matches!(self.channels, 2 | 4)
    }
}

impl ImageFileFormat {
    /// Its name; of compressed formats, as in `foxglove.CompressedImage` and `sensor_msgs/CompressedImage`.
    pub fn name(self) -> &'static str {
        match self {
            Self::Jpeg => "jpeg",
            Self::Png => "png",
            Self::Pnm => "pnm",
        }
    }

    /// The format that a file of this beginning has.
    pub fn of_bytes(bytes: &[u8]) -> Option<Self> {
        match bytes {
            [0xFF, 0xD8, 0xFF, ..] => Some(Self::Jpeg),
            [0x89, b'P', b'N', b'G', ..] => Some(Self::Png),
            [b'P', b'5' | b'6', space, ..] if space.is_ascii_whitespace() => Some(Self::Pnm),
            _ => None,
        }
    }
}

impl EncodedImage {
    /// Stores the file without decoding it.
    pub fn new(format: ImageFileFormat, bytes: impl Into<Arc<[u8]>>) -> Self {
        Self { format, bytes: bytes.into() }
    }

    /// Stores a file in the format that its first bytes indicate; `None` if they indicate none.
    pub fn from_bytes(bytes: impl Into<Arc<[u8]>>) -> Option<Self> {
        let bytes = bytes.into();
        Some(Self { format: ImageFileFormat::of_bytes(&bytes)?, bytes })
    }

    /// Its type on the web.
    pub fn media_type(&self) -> &'static str {
        match self.format {
            ImageFileFormat::Jpeg => "image/jpeg",
            ImageFileFormat::Png => "image/png",
            ImageFileFormat::Pnm => "image/x-portable-anymap",
        }
    }
}

impl fmt::Debug for EncodedImage {
    /// Omits the bytes from the debug output.
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(f, "EncodedImage({}, {} bytes)", self.format.name(), self.bytes.len())
    }
}
