use nalgebra::{Matrix3, Vector3};
use wayfix_estimation_traits::{LieGroup, MotionModel, Pose2};

/// A body velocity, constant for a time.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct VelocityControl {
    /// Forward, m/s.
    pub linear: f64,
    /// Counter-clockwise, rad/s.
    pub angular: f64,
    /// Duration, s.
    pub duration: f64,
}

/// Velocity commands: $`x' = x ∘ \exp(f v Δt, 0, ω Δt)`$, an arc of constant curvature. [Thrun et al. 2005, section 5.3]
///
/// $`f = \max(0.2, 1 - κ|ω|)`$ is the share of the commanded speed that remains in a turn; $`κ = 0`$ for a robot without speed loss.
///
/// The noise is a random walk, $`\mathrm{var}(Δs) = (σ_v^2 + σ_d^2 |v|) Δt`$ and $`\mathrm{var}(Δθ) = (σ_ω^2 + σ_t^2 |ω| + σ_s^2 |v|) Δt`$, so
/// the result does not depend on the sampling of the log. The heading error acts at the middle of the arc and causes a small lateral error.
#[derive(Clone, Copy, Debug, PartialEq)]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
#[cfg_attr(
    feature = "serde",
    derive(serde::Serialize, serde::Deserialize),
    serde(default, deny_unknown_fields)
)]
pub struct VelocityMotion {
    /// Standard deviation of the distance driven in one second, m/√s.
    pub linear_sigma: f64,
    /// Standard deviation of the heading after driving for one second, rad/√s.
    pub angular_sigma: f64,
    /// Standard deviation of the heading after turning by one radian, rad/√rad.
    pub turning_sigma: f64,
    /// Standard deviation of the distance after driving one metre, m/√m.
    pub linear_sigma_per_meter: f64,
    /// Standard deviation of the heading after driving one metre, rad/√m.
    pub angular_sigma_per_meter: f64,
    /// Factor on the first two while the commanded velocity is zero.
    pub standing_factor: f64,
    /// κ: share of the forward speed that is lost per rad/s of turning, s/rad.
    pub speed_loss_in_turns: f64,
}

impl Default for VelocityMotion {
    fn default() -> Self {
        Self {
            linear_sigma: 0.02,
            angular_sigma: 0.02,
            turning_sigma: 0.1,
            linear_sigma_per_meter: 0.0,
            angular_sigma_per_meter: 0.0,
            standing_factor: 0.25,
            speed_loss_in_turns: 0.0,
        }
    }
}

impl VelocityMotion {
    /// The motion of a command, without noise.
    pub fn increment(&self, control: &VelocityControl) -> Pose2<f64> {
        Pose2::exp(&Vector3::new(self.distance(control), 0.0, control.angular * control.duration))
    }

    fn distance(&self, control: &VelocityControl) -> f64 {
        let kept = (1.0 - self.speed_loss_in_turns * control.angular.abs()).max(0.2);
        control.linear * kept * control.duration
    }

    fn variances(&self, control: &VelocityControl) -> (f64, f64) {
        let standing = control.linear == 0.0 && control.angular == 0.0;
        let factor = if standing { self.standing_factor } else { 1.0 };
        let speed = control.linear.abs();
        let distance = (factor * self.linear_sigma).powi(2) + self.linear_sigma_per_meter.powi(2) * speed;
        let heading = (factor * self.angular_sigma).powi(2)
            + self.turning_sigma.powi(2) * control.angular.abs()
            + self.angular_sigma_per_meter.powi(2) * speed;
        (distance * control.duration, heading * control.duration)
    }
}

impl MotionModel for VelocityMotion {
    type State = Pose2<f64>;
    type Control = VelocityControl;

    fn propagate(&self, pose: &Pose2<f64>, control: &VelocityControl) -> Pose2<f64> {
        pose.compose(&self.increment(control))
    }

    fn jacobian(&self, _: &Pose2<f64>, control: &VelocityControl) -> Matrix3<f64> {
        self.increment(control).inverse().adjoint()
    }

    fn noise(&self, _: &Pose2<f64>, control: &VelocityControl) -> Matrix3<f64> {
        let (distance_variance, heading_variance) = self.variances(control);
        let (sin, cos) = (0.5 * control.angular * control.duration).sin_cos();
        let half = 0.5 * self.distance(control);
        let by_distance = Vector3::new(cos, -sin, 0.0); // direction of the middle of the arc, seen from its end
        let by_heading = Vector3::new(half * sin, half * cos, 1.0);
        by_distance * by_distance.transpose() * distance_variance
            + by_heading * by_heading.transpose() * heading_variance
    }
}
