use std::{fs, path::Path};

use anyhow::{Context, Result};
use wayfix_color_model::YuvStandard;
use wayfix_sensor_log::{DecodedImage, EncodedImage, ImageFileFormat, read_text};

use super::annotation::{BallCore, ObjectBox, read_boxes};
use super::carpet::Carpet;

/// Share of the rows above the horizon, which are skipped.
const HORIZON: f64 = 0.55;

/// The pixels of one image that count.
#[derive(Clone, Debug)]
pub(super) struct VenueImage {
    /// The carpet, found without annotation.
    pub(super) carpet: Carpet,
    /// Pixels (Y, U, V) of the carpet outside of all boxes.
    pub(super) carpet_pixels: Vec<[u8; 3]>,
    /// Pixels of balls.
    pub(super) ball_pixels: Vec<[u8; 3]>,
}

impl VenueImage {
    /// Reads an image and its boxes; `None` if no carpet is visible.
    pub(super) fn read(path: &Path) -> Result<Option<Self>> {
        let bytes = fs::read(path).with_context(|| format!("cannot read {}", path.display()))?;
        let decoded = EncodedImage::new(ImageFileFormat::Jpeg, bytes)
            .decode_rgb()
            .with_context(|| format!("cannot decode {}", path.display()))?;
        let boxes = path.with_extension("txt");
        let text = read_text(&boxes).with_context(|| format!("cannot read {}", boxes.display()))?;
        let boxes = read_boxes(&text, decoded.width, decoded.height)
            .with_context(|| format!("boxes in {}", boxes.display()))?;
        Ok(Self::of(&decoded, &boxes))
    }

    fn of(image: &DecodedImage, boxes: &[ObjectBox]) -> Option<Self> {
        let balls: Vec<BallCore> =
            boxes.iter().filter_map(|object| object.ball_core(image.width, image.height)).collect();
        let mut ground = Vec::new();
        let mut ball_pixels = Vec::new();
        let (pixels, _) = image.pixels.as_chunks::<3>();
        for (index, &rgb) in pixels.iter().enumerate() {
            let (x, y) = center_of(index, image.width);
            let is_ball = balls.iter().any(|ball| ball.contains(x, y));
            let is_ground = is_ground(x, y, image, rgb);
            if is_ball || is_ground {
                let yuv = YuvStandard::Bt601Full.from_rgb(rgb);
                if is_ball {
                    ball_pixels.push(yuv);
                }
                if is_ground {
                    ground.push((yuv, boxes.iter().any(|object| object.contains(x, y))));
                }
            }
        }
        let all: Vec<[u8; 3]> = ground.iter().map(|(yuv, _)| *yuv).collect();
        let carpet = Carpet::find(&all)?;
        let counts = |(yuv, boxed): &([u8; 3], bool)| (!boxed && carpet.contains(*yuv)).then_some(*yuv);
        let carpet_pixels = ground.iter().filter_map(counts).collect();
        Some(Self { carpet, carpet_pixels, ball_pixels })
    }
}

fn center_of(index: usize, width: u32) -> (f64, f64) {
    let width = width as usize;
    ((index % width) as f64 + 0.5, (index / width) as f64 + 0.5)
}

/// Below the horizon, seen through the lens, and rather green.
fn is_ground(x: f64, y: f64, image: &DecodedImage, [r, g, b]: [u8; 3]) -> bool {
    let (width, height) = (f64::from(image.width), f64::from(image.height));
    let (dx, dy) = (2.0 * x / width - 1.0, 2.0 * y / height - 1.0);
    y > HORIZON * height && dx * dx + dy * dy < 1.0 && g > r && g > b
}
