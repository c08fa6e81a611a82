use super::VelocityControl;

/// A car with an encoder at one rear wheel; its reference point is the middle of the rear axle.
///
/// $`v = \frac{v_e}{1 - \tan α \, H / L},\quad ω = \frac{v}{L} \tan α`$ [Guivant & Nebot 2001, Eqs. 1-3]
///
/// ```
/// use wayfix_slam_ekf::AckermannVehicle;
/// let truck = AckermannVehicle { wheel_base: 2.83, wheel_offset: 0.76 };
/// let straight = truck.velocity(3.0, 0.0, 0.1);
/// assert_eq!((straight.linear, straight.angular), (3.0, 0.0));
/// let left = truck.velocity(3.0, 0.3, 0.1);
/// assert!(left.linear > 3.0 && left.angular > 0.0); // the left wheel is on the inside of the turn
/// ```
#[derive(Clone, Copy, Debug, PartialEq)]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
#[cfg_attr(
    feature = "serde",
    derive(serde::Serialize, serde::Deserialize),
    serde(default, deny_unknown_fields)
)]
pub struct AckermannVehicle {
    /// L: between the axles, m.
    pub wheel_base: f64,
    /// H: from the middle of the rear axle to the wheel with the encoder, m; positive to the left.
    pub wheel_offset: f64,
}

impl Default for AckermannVehicle {
    /// The utility truck of the Victoria Park data set.
    fn default() -> Self {
        Self { wheel_base: 2.83, wheel_offset: 0.76 }
    }
}

impl AckermannVehicle {
    /// The velocity of the middle of the rear axle, with the encoder's wheel at `wheel_speed` m/s and the front wheels at `steering` rad (left
    /// positive) for `duration` seconds.
    pub fn velocity(&self, wheel_speed: f64, steering: f64, duration: f64) -> VelocityControl {
        let tangent = steering.tan();
        let linear = wheel_speed / (1.0 - tangent * self.wheel_offset / self.wheel_base);
        VelocityControl { linear, angular: linear * tangent / self.wheel_base, duration }
    }
}
