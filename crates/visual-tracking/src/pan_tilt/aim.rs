use crate::TrackingError;
use crate::error::checked;

/// Angles at which a pan/tilt head has its target in the middle of the picture.
///
/// The bearing of a target at pixel $`p`$ in a picture taken at angles $`α_t`$ is $`β_t = α_t + \arctan((p - c)/f)`$ on each axis. The head is sent to
/// $`β_t + d (β_t - β_{t-1})`$: where the target is when the command has its effect, $`d`$ pictures later, if its velocity is constant. The
/// formula takes the axes as independent, which holds near the middle of the picture.
///
/// ```
/// use wayfix_visual_tracking::PanTiltAim;
/// let mut aim = PanTiltAim::new(100.0, [80.0, 60.0], 2.0)?;
/// let first = aim.at([0.0, 0.0], [80.0, 60.0]);
/// assert_eq!(first, [0.0, 0.0]); // in the middle, and not known to move
/// let next = aim.at([0.0, 0.0], [90.0, 60.0]);
/// assert!((next[0] - 3.0 * 0.1_f64.atan()).abs() < 1e-12 && next[1] == 0.0);
/// # Ok::<(), wayfix_visual_tracking::TrackingError>(())
/// ```
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct PanTiltAim {
    focal_length_px: f64,
    principal_point: [f64; 2],
    delay: f64,
    last_bearing: Option<[f64; 2]>,
}

impl PanTiltAim {
    /// With the focal length and the principal point $`c`$ in pixels, and the delay $`d`$ in pictures.
    ///
    /// # Errors
    /// Returns [`TrackingError::Parameter`] for a focal length that is not positive, a negative delay or a number that is not finite.
    pub fn new(focal_length_px: f64, principal_point: [f64; 2], delay: f64) -> Result<Self, TrackingError> {
        let positive = focal_length_px > 0.0 && focal_length_px.is_finite();
        checked("focal length", focal_length_px, positive, "positive, finite")?;
        for value in principal_point {
            checked("principal point", value, value.is_finite(), "finite")?;
        }
        checked("delay of the head", delay, delay >= 0.0 && delay.is_finite(), "not negative, finite")?;
        Ok(Self { focal_length_px, principal_point, delay, last_bearing: None })
    }

    /// Angles for the head, of which the last picture was taken at `angles` and shows the target at `center`.
    pub fn at(&mut self, angles: [f64; 2], center: [f64; 2]) -> [f64; 2] {
        let off = |axis: usize| (center[axis] - self.principal_point[axis]) / self.focal_length_px;
        let bearing = [0, 1].map(|axis| angles[axis] + libm::atan(off(axis)));
        let last = self.last_bearing.replace(bearing).unwrap_or(bearing);
        [0, 1].map(|axis| bearing[axis] + self.delay * (bearing[axis] - last[axis]))
    }

    /// How far what stands still moves in the picture when the head turns, in pixels.
    pub(super) fn shift(&self, from: [f64; 2], to: [f64; 2]) -> [f64; 2] {
        [0, 1].map(|axis| -self.focal_length_px * libm::tan(to[axis] - from[axis]))
    }

    /// Forgets the velocity, as after a picture without the target.
    pub fn forget(&mut self) {
        self.last_bearing = None;
    }
}
