use nalgebra::Vector3;
use serde::{Deserialize, Serialize};
use wayfix_estimation_traits::{LieGroup, Pose2};
use wayfix_sensor_log::{Stamp, Velocity};

/// Largest accepted speed, m/s, and turn rate, rad/s. An impossible velocity would move the robot until the next one.
pub const MAX_SPEED: f64 = 1e3;

/// Default time after its stamp for which a velocity holds, s: the command time-out of ROS 2 navigation.
pub const VELOCITY_TIMEOUT: f64 = 1.0;

/// Accepts a velocity that is finite and at most [`MAX_SPEED`].
///
/// # Errors
/// Returns a description of a rejected velocity.
pub fn check_velocity(velocity: Velocity) -> Result<Velocity, String> {
    let Velocity { linear, angular } = velocity;
    if linear.abs() <= MAX_SPEED && angular.abs() <= MAX_SPEED {
        return Ok(velocity);
    }
    Err(format!("a velocity of {linear:.3e} m/s and {angular:.3e} rad/s is beyond {MAX_SPEED} or not finite"))
}

/// A velocity that holds until the next one, for a limited time.
#[derive(Clone, Copy, Debug, Default, PartialEq, Serialize, Deserialize)]
pub struct HeldVelocity {
    held: Option<Held>,
}

#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
struct Held {
    /// Stamp of the velocity, nanoseconds.
    stamp: u64,
    /// End of the motion already used, nanoseconds.
    used_until: u64,
    linear: f64,
    angular: f64,
}

/// The motion over an interval.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct HeldVelocityMotion {
    /// The motion while the velocity holds.
    pub increment: Pose2<f64>,
    /// Time for which the velocity holds, s.
    pub seconds: f64,
    /// Time after that with unknown motion, s.
    pub unknown_seconds: f64,
}

impl HeldVelocity {
    /// Sets the velocity from `stamp` on.
    ///
    /// # Errors
    /// Returns an error if [`check_velocity`] rejects it; the previous velocity remains.
    pub fn hold(&mut self, stamp: Stamp, velocity: Velocity) -> Result<(), String> {
        let Velocity { linear, angular } = check_velocity(velocity)?;
        let stamp = stamp.nanoseconds();
        self.held = Some(Held { stamp, used_until: stamp, linear, angular });
        Ok(())
    }

    /// The motion from the last call to `stamp`; `None` without a velocity or if no time has passed.
    ///
    /// The velocity holds for `longest` seconds after its stamp.
    pub fn motion_until(&mut self, stamp: Stamp, longest: f64) -> Option<HeldVelocityMotion> {
        let Held { stamp: since, used_until, linear, angular } = self.held?;
        let now = stamp.nanoseconds();
        if now <= used_until {
            return None;
        }
        let expires = since.saturating_add((longest * 1e9) as u64);
        let seconds = now.min(expires).saturating_sub(used_until) as f64 * 1e-9;
        let unknown_seconds = now.saturating_sub(used_until.max(expires)) as f64 * 1e-9;
        self.held = Some(Held { stamp: since, used_until: now, linear, angular });
        let increment = Pose2::exp(&Vector3::new(linear * seconds, 0.0, angular * seconds));
        Some(HeldVelocityMotion { increment, seconds, unknown_seconds })
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use approx::assert_abs_diff_eq;

    fn at(milliseconds: u64) -> Stamp {
        Stamp::from_nanoseconds(milliseconds * 1_000_000)
    }

    const FORWARD: Velocity = Velocity { linear: 2.0, angular: 0.0 };

    #[test]
    fn velocity_holds_until_the_next() {
        let mut held = HeldVelocity::default();
        assert_eq!(held.motion_until(at(5), 1.0), None);
        held.hold(at(1000), FORWARD).unwrap();
        assert_abs_diff_eq!(held.motion_until(at(1500), 1.0).unwrap().increment.x(), 1.0, epsilon = 1e-12);
        assert_eq!(held.motion_until(at(1500), 1.0), None);
        assert_abs_diff_eq!(held.motion_until(at(1600), 1.0).unwrap().increment.x(), 0.2, epsilon = 1e-9);
    }

    #[test]
    fn velocity_expires_and_the_rest_is_unknown() {
        let mut held = HeldVelocity::default();
        held.hold(at(1000), FORWARD).unwrap();
        let motion = held.motion_until(at(4000), 1.0).unwrap();
        assert_abs_diff_eq!(motion.increment.x(), 2.0, epsilon = 1e-12);
        assert_abs_diff_eq!(motion.unknown_seconds, 2.0, epsilon = 1e-12);
        let motion = held.motion_until(at(4500), 1.0).unwrap();
        assert_abs_diff_eq!(motion.unknown_seconds, 0.5, epsilon = 1e-12);
        assert!(motion.increment.x() == 0.0);
    }

    #[test]
    fn impossible_velocity_is_refused_and_the_last_one_holds() {
        for linear in [1e256, f64::NAN, f64::NEG_INFINITY] {
            let mut held = HeldVelocity::default();
            held.hold(at(0), FORWARD).unwrap();
            let error = held.hold(at(100), Velocity { linear, angular: 0.0 }).unwrap_err();
            assert!(error.len() < 120, "{error}");
            assert_abs_diff_eq!(held.motion_until(at(200), 1.0).unwrap().increment.x(), 0.4, epsilon = 1e-12);
        }
    }
}
