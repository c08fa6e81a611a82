use wayfix_evaluation::plot::Decimated;
use wayfix_sensor_log::{EncodedImage, ImageError};
use wayfix_visual_tracking::{TargetEstimate, TrackStatus};

use super::super::{TargetColorDistribution, TargetTruth, TrackFrameResult};
use super::overlay;

/// Maximum number of film frames.
const MOST_FRAMES: usize = 12;
const MOST_POINTS: usize = 4000;
/// Maximum number of colour distributions along their path; each has its own ink.
const MOST_CLOUDS: usize = 6;
const JPEG_QUALITY: u8 = 85;

/// Data of a run kept for the pictures, of bounded size.
pub struct TrackRunHistory {
    pub(in crate::track) film: Decimated<(usize, EncodedImage)>,
    pub(in crate::track) points: Decimated<Point>,
    pub(in crate::track) clouds: Decimated<(usize, TargetColorDistribution)>,
    pub(in crate::track) frame_size: (u32, u32),
}

/// One frame in the curves.
#[derive(Clone, Copy, Debug)]
pub(in crate::track) struct Point {
    pub(in crate::track) index: usize,
    pub(in crate::track) iou: Option<f64>,
    pub(in crate::track) quality: f64,
    pub(in crate::track) colors: Option<TargetColorDistribution>,
}

impl Default for TrackRunHistory {
    fn default() -> Self {
        Self {
            film: Decimated::new(MOST_FRAMES),
            points: Decimated::new(MOST_POINTS),
            clouds: Decimated::new(MOST_CLOUDS),
            frame_size: (0, 0),
        }
    }
}

impl TrackRunHistory {
    /// Adds the next frame.
    ///
    /// # Errors
    /// Returns an error if its picture cannot be encoded.
    pub fn observe(&mut self, frame: &TrackFrameResult) -> Result<(), ImageError> {
        let (index, colors) = (frame.index, frame.colors);
        let point = Point { index, iou: frame.iou, quality: frame.target.quality, colors };
        self.points.push(point);
        if let Some(colors) = colors {
            self.clouds.push((index, colors));
        }
        let (width, height) = (frame.picture.width(), frame.picture.height());
        if self.frame_size == (0, 0) {
            self.frame_size = (width, height);
        }
        self.film.offer(|| {
            let mut picture = frame.picture.clone();
            if let TargetTruth::At(truth) = frame.truth {
                overlay::draw(&mut picture, &overlay::corners(&truth), overlay::TRUTH);
            }
            let color =
                if frame.target.status == TrackStatus::Lost { overlay::LOST } else { overlay::ESTIMATE };
            overlay::draw(&mut picture, &outline(&frame.target), color);
            Ok((frame.index, EncodedImage::jpeg(width, height, picture.as_raw(), JPEG_QUALITY)?))
        })
    }
}

/// The outline of a target, or its box when it has none.
pub(in crate::track) fn outline(target: &TargetEstimate) -> Vec<[f64; 2]> {
    if target.outline.is_empty() {
        overlay::corners(&target.bounding_box).to_vec()
    } else {
        target.outline.clone()
    }
}
