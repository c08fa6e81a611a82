/// Encoder and steering readings of a car-like vehicle, as measured.
///
/// The position of the wheel and the steering geometry belong to the vehicle, not to the log. With the encoder on the inner side of a left turn,
/// half a track width $`H`$ off the middle, and the wheelbase $`L`$, the middle of the rear axle moves with
/// $`v = v_{wheel} / (1 - \tan(\alpha) H / L)`$ [Guivant & Nebot 2001].
/// ```
/// use wayfix_sensor_log::{AckermannDrive, RecordData};
/// let drive = AckermannDrive { wheel_speed: 2.0, steering: 0.1 };
/// assert_eq!(RecordData::Ackermann(drive).kind(), "ackermann drive");
/// ```
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct AckermannDrive {
    /// Speed over the ground of the wheel that carries the encoder (Victoria Park: the rear left one), m/s.
    pub wheel_speed: f64,
    /// Angle of the steered axle, radians, positive to the left.
    pub steering: f64,
}
