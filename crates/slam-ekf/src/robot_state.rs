use nalgebra::{DefaultAllocator, DimName, Matrix3, allocator::Allocator};
use wayfix_estimation_traits::{Manifold, Pose2, Tangent, TangentMatrix, numerical_jacobian};

/// What the filter estimates of the robot: a pose, or a pose with whatever else is wrong with it (biases, scales, a calibration).
///
/// **Law**: [`transport`](Self::transport) is the derivative of $`δ ↦ (x ⊞ \hat δ)^{-1} (x ⊞ (\hat δ + δ))`$, that is, of
/// `x.retract(step).local(&x.retract(step + δ))` at $`δ = 0`$; the identity for flat states.
pub trait RobotState: Manifold<Scalar = f64, Dim: DimName> + std::fmt::Debug
where
    DefaultAllocator: Allocator<Self::Dim> + Allocator<Self::Dim, Self::Dim>,
{
    /// How a covariance in the tangent space here reads in the tangent space after `step`. By default a central difference.
    ///
    /// Without it the covariance would stay in the frame of the old heading after every correction. With it the filter is the same,
    /// number for number, as one that keeps the robot's error in world coordinates.
    fn transport(&self, step: &Tangent<Self>) -> TangentMatrix<Self> {
        numerical_jacobian(|step: &Tangent<Self>| self.retract(step), step)
    }
}

impl RobotState for Pose2<f64> {
    /// Translations turn back by the step's rotation.
    fn transport(&self, step: &Tangent<Self>) -> Matrix3<f64> {
        let (sin, cos) = step.z.sin_cos();
        Matrix3::new(
            cos, sin, 0.0, //
            -sin, cos, 0.0, //
            0.0, 0.0, 1.0,
        )
    }
}

#[cfg(test)]
mod tests {
    use nalgebra::Vector3;

    use super::*;

    #[test]
    fn transport_is_the_derivative_of_the_retraction() {
        let pose = Pose2::new(1.0, -2.0, 2.5);
        for step in [Vector3::zeros(), Vector3::new(0.3, -0.2, 0.7), Vector3::new(-1.0, 2.0, -1.2)] {
            let numerical = numerical_jacobian(|step: &Vector3<f64>| pose.retract(step), &step);
            assert!((pose.transport(&step) - numerical).amax() < 1e-9); // central difference: ε^(2/3)
        }
    }
}
