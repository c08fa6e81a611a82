/// A pan/tilt head: angles `[pan, tilt]` in radians, pan positive to the right and tilt positive downwards, as columns and rows of a picture are.
///
/// ```
/// use wayfix_visual_tracking::PanTiltHead;
/// struct Unplugged;
/// impl PanTiltHead for Unplugged {
///     type Error = &'static str;
///     fn angles(&mut self) -> Result<[f64; 2], Self::Error> {
///         Err("no answer within 50 ms")
///     }
///     fn turn_to(&mut self, _angles: [f64; 2]) -> Result<(), Self::Error> {
///         Err("no answer within 50 ms")
///     }
/// }
/// assert!(Unplugged.angles().is_err());
/// ```
pub trait PanTiltHead {
    /// Why the head does not answer.
    type Error;

    /// The angles at which the last picture was taken.
    ///
    /// # Errors
    /// Returns an error if the head does not answer.
    fn angles(&mut self) -> Result<[f64; 2], Self::Error>;

    /// Turns towards these angles; the head keeps its own limits.
    ///
    /// # Errors
    /// Returns an error if the head does not answer.
    fn turn_to(&mut self, angles: [f64; 2]) -> Result<(), Self::Error>;
}
