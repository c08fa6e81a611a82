//! Decoded pixels do not depend on the processor's vector instructions.
//!
//! The JPEG decoder (zune-jpeg 0.5.15) picks its code for AVX2, Neon or neither when it runs. The digests below are what it gives when it is built
//! with neither (`default-features = false, features = ["std"]`), so this test fails on a machine where vector instructions give other bits.
//! Measured once beside it: of 26 733 copies with one flipped bit, outside the bytes 151 to 169 where most have their size, 1754 were errors
//! in both builds and all others gave the same bits with AVX2 as without.

use std::fs;

use wayfix_sensor_log::{EncodedImage, ImageFileFormat};

const WITHOUT_VECTOR_INSTRUCTIONS: [(&str, u64); 9] = [
    ("cmyk.jpg", 0x417f_d796_b943_2e8a),
    ("gray.jpg", 0x1912_766a_3230_dfb3),
    ("noise_1.jpg", 0x8404_1e19_a4c8_886e),
    ("noise_100.jpg", 0x4c17_fe4a_8ae8_2ce3),
    ("noise_50.jpg", 0xd31e_a266_1a1a_7047),
    ("progressive.jpg", 0x67dc_b6c2_a1f8_7b8a),
    ("restarts.jpg", 0x6be4_905d_7759_cf02),
    ("subsampled_420.jpg", 0x6be4_905d_7759_cf02),
    ("subsampled_422.jpg", 0x0f06_c5c2_6cdb_2ead),
];

/// FNV-1a.
fn digest(bytes: &[u8]) -> u64 {
    bytes
        .iter()
        .fold(0xcbf2_9ce4_8422_2325, |hash, byte| (hash ^ u64::from(*byte)).wrapping_mul(0x0100_0000_01b3))
}

#[test]
fn jpeg_gives_the_same_bits_as_without_vector_instructions() {
    for (name, expected) in WITHOUT_VECTOR_INSTRUCTIONS {
        let path = format!("{}/tests/images/{name}", env!("CARGO_MANIFEST_DIR"));
        let image = EncodedImage::new(ImageFileFormat::Jpeg, fs::read(path).unwrap()).decode_rgb().unwrap();
        assert_eq!((image.width, image.height), (70, 46), "{name}");
        assert_eq!(digest(&image.pixels), expected, "{name}");
    }
}
