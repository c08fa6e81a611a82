use rand::Rng;

use super::BoundingBox;
use crate::{RgbImage, TrackingError};

/// What a tracker says of one picture.
#[derive(Clone, Debug, PartialEq)]
pub struct Target {
    /// Around the target; while it is lost, where it was seen last.
    pub bounding_box: BoundingBox,
    /// The closed outline, points `[u, v]` in pixels in order around the target; empty when only a box is known.
    pub outline: Vec<[f64; 2]>,
    /// Whether the tracker believes what it says.
    pub status: TrackStatus,
    /// How well the target is recognized, from 0 to 1.
    pub quality: f64,
}

/// Whether the target is in sight.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum TrackStatus {
    /// It is where the tracker says.
    Tracked,
    /// It is not, and is being looked for.
    Lost,
}

/// Follows one target, one picture at a time.
///
/// **Laws**: an error leaves the tracker as it was; the same pictures and the same generator give the same bits.
pub trait Tracker {
    /// Takes the next picture.
    ///
    /// # Errors
    /// Whatever makes the picture unusable, such as a size that is not that of the first one.
    fn track<R: Rng + ?Sized>(&mut self, picture: &RgbImage, rng: &mut R) -> Result<Target, TrackingError>;
}
