use nalgebra::{Matrix3, Vector3};
use wayfix_estimation_traits::{LieGroup, MotionModel, Pose2};

/// A body velocity held for a time.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct VelocityControl {
    /// Forward, m/s.
    pub linear: f64,
    /// Counter-clockwise, rad/s.
    pub angular: f64,
    /// How long, s.
    pub duration: f64,
}

impl VelocityControl {
    /// The motion as an increment: an arc of constant curvature, $`\exp(v Δt, 0, ω Δt)`$.
    pub fn increment(&self) -> Pose2<f64> {
        Pose2::exp(&Vector3::new(self.linear * self.duration, 0.0, self.angular * self.duration))
    }
}

/// Velocity commands: $`x' = x ∘ \exp(v Δt, 0, ω Δt)`$. [Thrun et al. 2005, section 5.3]
///
/// The noise is a random walk in distance and heading, $`\mathrm{var}(Δs) = σ_v^2 Δt`$, so that the result does not
/// depend on how finely a log cuts time.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct VelocityMotion {
    /// Standard deviation of the distance travelled in one second, m/√s.
    pub linear_sigma: f64,
    /// Standard deviation of the sideways slip in one second, m/√s.
    pub lateral_sigma: f64,
    /// Standard deviation of the heading turned in one second, rad/√s.
    pub angular_sigma: f64,
}

impl Default for VelocityMotion {
    fn default() -> Self {
        Self { linear_sigma: 0.02, lateral_sigma: 0.0, angular_sigma: 0.05 }
    }
}

impl MotionModel for VelocityMotion {
    type State = Pose2<f64>;
    type Control = VelocityControl;

    fn propagate(&self, pose: &Pose2<f64>, control: &VelocityControl) -> Pose2<f64> {
        pose.compose(&control.increment())
    }

    fn jacobian(&self, _: &Pose2<f64>, control: &VelocityControl) -> Matrix3<f64> {
        control.increment().inverse().adjoint()
    }

    fn noise(&self, _: &Pose2<f64>, control: &VelocityControl) -> Matrix3<f64> {
        let variances =
            Vector3::new(self.linear_sigma.powi(2), self.lateral_sigma.powi(2), self.angular_sigma.powi(2));
        Matrix3::from_diagonal(&(variances * control.duration))
    }
}
