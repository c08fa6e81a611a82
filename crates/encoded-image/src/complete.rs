use crate::{Anymap, ImageFileFormat};

impl ImageFileFormat {
    /// Whether a file reaches its end mark. Decoders fill missing pixels with grey without an error.
    pub(crate) fn is_complete(self, bytes: &[u8]) -> bool {
        match self {
            Self::Jpeg => is_complete_jpeg(bytes).is_some(),
            Self::Png => is_complete_png(bytes).is_some(),
            Self::Pnm => Anymap::of(bytes).is_some_and(|image| image.is_complete()),
        }
    }
}

/// Steps from marker to marker, over segments by their length, so that the end of a thumbnail is not mistaken for the end of the image.
fn is_complete_jpeg(bytes: &[u8]) -> Option<()> {
    const END_OF_IMAGE: u8 = 0xD9;
    let mut rest = bytes.get(2..)?;
    loop {
        let at = rest.windows(2).position(|pair| pair[0] == 0xFF && has_segment(pair[1]))?;
        if rest[at + 1] == END_OF_IMAGE {
            return Some(());
        }
        let length = u16::from_be_bytes([*rest.get(at + 2)?, *rest.get(at + 3)?]);
        rest = rest.get(at + 2 + usize::from(length)..)?;
    }
}

/// `false` for zero (a stuffed byte), restarts, fill bytes and the reserved marker 0x01.
fn has_segment(marker: u8) -> bool {
    !matches!(marker, 0x00 | 0x01 | 0xD0..=0xD7 | 0xFF)
}

fn is_complete_png(bytes: &[u8]) -> Option<()> {
    let mut rest = bytes.get(8..)?;
    loop {
        let (length, kind) = (rest.get(..4)?, rest.get(4..8)?);
        let length = u32::from_be_bytes(length.try_into().ok()?);
        // Length, kind and checksum take four bytes each.
        rest = rest.get((length as usize).checked_add(12)?..)?;
        if kind == b"IEND" {
            return Some(());
        }
    }
}
