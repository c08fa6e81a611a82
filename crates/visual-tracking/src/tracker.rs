use rand::Rng;

use super::BoundingBox;
use crate::{RgbImage, TrackingError};

/// Estimate of the target in one image.
#[derive(Clone, Debug, PartialEq)]
pub struct TargetEstimate {
    /// Around the target; while it is lost, where it was seen last.
    pub bounding_box: BoundingBox,
    /// The closed outline, points `[u, v]` in pixels in order around the target; empty if only a box is known.
    pub outline: Vec<[f64; 2]>,
    /// Whether the target is tracked or lost.
    pub status: TrackStatus,
    /// Recognition quality, from 0 to 1.
    pub quality: f64,
}

/// Whether the target is in sight.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum TrackStatus {
    /// The target is at the estimated position.
    Tracked,
    /// The target is not found; the tracker searches for it.
    Lost,
}

/// Tracks one target, one image at a time.
///
/// **Laws**: an error leaves the tracker unchanged; equal images and equal generators give equal bits.
pub trait Tracker {
    /// Takes the next picture.
    ///
    /// # Errors
    /// Returns an error if the image is unusable, for example if it differs from the first one in size.
    fn track<R: Rng + ?Sized>(
        &mut self,
        picture: &RgbImage,
        rng: &mut R,
    ) -> Result<TargetEstimate, TrackingError>;

    /// The camera has turned since the last picture: what stands still moves by `shift` pixels from there to the next one. A tracker without a
    /// motion model ignores it.
    fn camera_turned(&mut self, shift: [f64; 2]) {
        let _ = shift;
    }
}
