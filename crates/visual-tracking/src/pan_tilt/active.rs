use rand::Rng;

use super::{PanTiltAim, PanTiltHead};
use crate::{RgbImage, TargetEstimate, TrackStatus, Tracker, TrackingError};

/// A tracker whose camera follows the target.
///
/// The head stops while the target is lost. A head that does not answer is counted; the tracker continues without it.
///
/// ```
/// use rand::SeedableRng;
/// use wayfix_visual_tracking::{
///     ActiveTracker, BoundingBox, HeadTracker, PanTiltAim, PanTiltHead, PanTiltLimits, RgbImage, SimulatedPanTilt,
/// };
/// let picture = RgbImage::from_fn(100, 60, |u, v| {
///     let inside = (f64::from(u) - 60.0).hypot(f64::from(v) - 30.0) < 12.0;
///     image::Rgb(if inside { [220, 160, 130] } else { [90, 120, 150] })
/// });
/// let head = BoundingBox::from_center([60.0, 30.0], 24.0, 24.0)?;
/// let tracker = HeadTracker::new(&picture, head, Default::default())?;
/// let (aim, limits) = (PanTiltAim::new(100.0, [50.0, 30.0], 1.0)?, PanTiltLimits::default());
/// let mut active = ActiveTracker::new(tracker, aim, SimulatedPanTilt::new(limits, 0, 0.04)?);
/// active.step(&picture, &mut rand_chacha::ChaCha8Rng::seed_from_u64(1))?;
/// active.head.advance(); // the time until the next picture
/// assert!(active.head.angles().is_ok_and(|[pan, _]| (pan - 0.1).abs() < 0.02));
/// # Ok::<(), wayfix_visual_tracking::TrackingError>(())
/// ```
#[derive(Clone, Debug)]
pub struct ActiveTracker<T, H> {
    /// The tracker.
    pub tracker: T,
    /// The head that carries the camera.
    pub head: H,
    aim: PanTiltAim,
    last_angles: Option<[f64; 2]>,
    n_unanswered: u64,
}

/// The target in one picture, and what became of the command to the head.
#[derive(Clone, Debug, PartialEq)]
pub struct ActiveEstimate<E> {
    /// The target in the picture.
    pub target: TargetEstimate,
    /// The angles the head was sent to; `None` for a lost target.
    pub sent: Result<Option<[f64; 2]>, E>,
}

impl<T: Tracker, H: PanTiltHead> ActiveTracker<T, H> {
    /// A tracker that has begun, on a head.
    pub fn new(tracker: T, aim: PanTiltAim, head: H) -> Self {
        Self { tracker, head, aim, last_angles: None, n_unanswered: 0 }
    }

    /// Tracks the target in a picture and turns the head after it.
    ///
    /// # Errors
    /// Returns the errors of the tracker; the head then gets no command.
    pub fn step<R: Rng + ?Sized>(
        &mut self,
        picture: &RgbImage,
        rng: &mut R,
    ) -> Result<ActiveEstimate<H::Error>, TrackingError> {
        let angles = self.head.angles();
        let now = angles.as_ref().ok().copied();
        if let (Some(last), Some(now)) = (self.last_angles, now) {
            self.tracker.camera_turned(self.aim.shift(last, now));
        }
        self.last_angles = now;
        let target = self.tracker.track(picture, rng)?;
        let sent = match angles {
            Ok(angles) if target.status == TrackStatus::Tracked => {
                let wanted = self.aim.at(angles, target.bounding_box.center());
                self.head.turn_to(wanted).map(|()| Some(wanted))
            }
            other => {
                self.aim.forget();
                other.map(|_| None)
            }
        };
        self.n_unanswered += u64::from(sent.is_err());
        Ok(ActiveEstimate { target, sent })
    }

    /// Number of pictures in which the head did not answer.
    pub fn n_unanswered(&self) -> u64 {
        self.n_unanswered
    }
}
