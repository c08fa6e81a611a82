use std::{collections::VecDeque, ops::RangeInclusive};

use super::PanTiltHead;
use crate::TrackingError;
use crate::error::checked;

/// What a pan/tilt head can do. The default has the limits of the data sheet of a PTU-46-17.5: 300 °/s, pan ±159°, tilt 47° down and 31° up.
#[derive(Clone, Debug, PartialEq)]
pub struct PanTiltLimits {
    /// Largest rate of each axis, rad/s.
    pub rate: f64,
    /// Range of the pan angle, rad.
    pub pan: RangeInclusive<f64>,
    /// Range of the tilt angle, rad.
    pub tilt: RangeInclusive<f64>,
}

impl Default for PanTiltLimits {
    fn default() -> Self {
        let [rate, pan, up, down] = [300.0_f64, 159.0, 31.0, 47.0].map(f64::to_radians);
        Self { rate, pan: -pan..=pan, tilt: -up..=down }
    }
}

/// A simulated head: commands take effect some pictures late, and turn it within its limits.
///
/// ```
/// use wayfix_visual_tracking::{PanTiltHead, PanTiltLimits, SimulatedPanTilt};
/// let limits = PanTiltLimits { rate: 1.0, pan: -0.15..=0.15, tilt: -0.1..=0.1 };
/// let mut head = SimulatedPanTilt::new(limits, 1, 0.1)?;
/// head.turn_to([2.0, 0.0])?;
/// let mut pans = vec![];
/// for _ in 0..4 {
///     head.advance();
///     pans.push(head.angles()?[0]);
/// }
/// assert_eq!(pans, [0.0, 0.1, 0.15, 0.15]); // late, then at its rate, then at its end
/// # Ok::<(), wayfix_visual_tracking::TrackingError>(())
/// ```
#[derive(Clone, Debug, PartialEq)]
pub struct SimulatedPanTilt {
    limits: PanTiltLimits,
    period_s: f64,
    angles: [f64; 2],
    /// Commands from the newest that has its effect on.
    commands: VecDeque<[f64; 2]>,
    newest: [f64; 2],
}

impl SimulatedPanTilt {
    /// At rest at `[0, 0]`; commands take effect `delay` pictures late, of which one comes every `period_s` seconds.
    ///
    /// # Errors
    /// Returns [`TrackingError::Parameter`] for a rate or period that is not positive, or a range without 0.
    pub fn new(limits: PanTiltLimits, delay: usize, period_s: f64) -> Result<Self, TrackingError> {
        checked("rate of the head", limits.rate, limits.rate > 0.0, "positive")?;
        let valid = period_s > 0.0 && period_s.is_finite();
        checked("period of the pictures", period_s, valid, "positive, finite")?;
        for range in [&limits.pan, &limits.tilt] {
            checked("least angle of the head", *range.start(), range.contains(&0.0), "a range with 0")?;
        }
        let commands = VecDeque::from(vec![[0.0; 2]; delay + 1]);
        Ok(Self { limits, period_s, angles: [0.0; 2], commands, newest: [0.0; 2] })
    }

    /// Lets the time of one picture pass.
    pub fn advance(&mut self) {
        self.commands.push_back(self.newest);
        self.commands.pop_front();
        let Some(wanted) = self.commands.front() else { return };
        let step = self.limits.rate * self.period_s;
        for (axis, range) in [&self.limits.pan, &self.limits.tilt].into_iter().enumerate() {
            let turned = (wanted[axis] - self.angles[axis]).clamp(-step, step);
            self.angles[axis] = (self.angles[axis] + turned).clamp(*range.start(), *range.end());
        }
    }
}

impl PanTiltHead for SimulatedPanTilt {
    type Error = TrackingError;

    fn angles(&mut self) -> Result<[f64; 2], TrackingError> {
        Ok(self.angles)
    }

    fn turn_to(&mut self, angles: [f64; 2]) -> Result<(), TrackingError> {
        if let Some(index) = angles.iter().position(|angle| !angle.is_finite()) {
            return Err(TrackingError::NotFinite { what: "angle of the head", index, value: angles[index] });
        }
        self.newest = angles;
        Ok(())
    }
}
