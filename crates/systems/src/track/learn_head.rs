use std::{ops::RangeBounds, path::Path};

use wayfix_sensor_log::{EncodedImage, Log, RecordData, Stamp};
use wayfix_visual_tracking::{BoundingBox, HeadDetector, HeadTrackerParams, RgbImage};

use super::{TrackSystemError, TrueBoxes};

/// Learns a head from the images of a log with these numbers and their true boxes; images without a box or that cannot be read teach nothing. `path` names the log in
/// errors.
///
/// # Errors
/// Returns [`TrackSystemError::Examples`] if no image has a box, or a box is outside its image.
pub fn learn_head(
    log: &mut Log,
    truth: &TrueBoxes,
    rate_hz: Option<f64>,
    frames: impl RangeBounds<usize>,
    params: &HeadTrackerParams,
    path: &Path,
) -> Result<HeadDetector, TrackSystemError> {
    let images = log.by_ref().filter_map(|record| match record.data {
        RecordData::Image(image) => Some((record.stamp, image)),
        _ => None,
    });
    // As in a run, the stamps of a folder give the number of a frame.
    let number = |count: usize, nanoseconds: u64| {
        rate_hz.map_or(count, |rate_hz| (nanoseconds as f64 * 1e-9 * rate_hz).round() as usize)
    };
    let example = |(count, (stamp, image)): (usize, (Stamp, EncodedImage))| {
        let frame = number(count, stamp.nanoseconds());
        let bounds = truth.at(frame).target().filter(|_| frames.contains(&frame))?;
        let decoded = image.decode_rgb().ok()?;
        Some((RgbImage::from_raw(decoded.width, decoded.height, decoded.pixels)?, bounds))
    };
    let examples: Vec<(RgbImage, BoundingBox)> = images.enumerate().filter_map(example).collect();
    let learned = HeadDetector::learn(examples.iter().map(|(picture, bounds)| (picture, *bounds)), params);
    learned.map_err(|source| TrackSystemError::Examples { path: path.to_owned(), source })
}
