use nalgebra::{DefaultAllocator, Matrix2, Matrix3, Vector3};
use wayfix_estimation_traits::{Manifold, MotionModel, Pose2};

use super::EkfSlam;
use crate::{LandmarkDim, LandmarkModel, MeasurementDim, SlamAlloc, SlamError};

impl<M: LandmarkModel> EkfSlam<M>
where
    DefaultAllocator: SlamAlloc<LandmarkDim<M>, MeasurementDim<M>>,
{
    /// Moves the robot: $`x_r ← f(x_r, u),\; P_{rr} ← F P_{rr} F^T + Q,\; P_{rm} ← F P_{rm}`$. Cost O(n).
    ///
    /// # Errors
    /// When the model gives anything that is not finite or a noise that is no covariance; nothing has changed then.
    pub fn predict<U: ?Sized>(
        &mut self,
        motion: &impl MotionModel<State = Pose2<f64>, Control = U>,
        control: &U,
    ) -> Result<(), SlamError> {
        let moved = motion.propagate(&self.robot, control);
        let (jacobian, noise) = (motion.jacobian(&self.robot, control), motion.noise(&self.robot, control));
        if !moved.is_finite() {
            return Err(SlamError::NotFinite { what: "propagated pose" });
        }
        if !jacobian.iter().all(|entry| entry.is_finite()) {
            return Err(SlamError::NotFinite { what: "motion Jacobian" });
        }
        check_covariance("motion noise", &noise)?;

        let before = self.covariance.robot();
        let robot = jacobian * before * jacobian.transpose() + noise;
        if !robot.iter().all(|entry| entry.abs() < LARGEST_VARIANCE) {
            return Err(SlamError::NotFinite { what: "predicted covariance" });
        }
        self.covariance.move_robot(&jacobian, &noise);
        self.robot = moved;
        Ok(())
    }

    /// Steps the robot's mean by `delta` and turns its covariance into the new body frame.
    ///
    /// Without this the covariance would stay in the frame of the old heading. With it the filter is the same, number for number,
    /// as one that keeps the robot's error in world coordinates.
    pub(super) fn step_robot(&mut self, delta: &Vector3<f64>) {
        self.robot = self.robot.retract(delta);
        let (sin, cos) = delta.z.sin_cos();
        let mut turn = Matrix3::identity();
        turn.fixed_view_mut::<2, 2>(0, 0).copy_from(&Matrix2::new(cos, sin, -sin, cos));
        self.covariance.move_robot(&turn, &Matrix3::zeros());
    }
}

/// Beyond this a variance says nothing (1e15 km²) and its products would overflow.
const LARGEST_VARIANCE: f64 = 1e36;

/// Refuses what is not symmetric positive semidefinite; zero variances are fine.
pub(super) fn check_covariance(what: &'static str, matrix: &Matrix3<f64>) -> Result<(), SlamError> {
    if !matrix.iter().all(|entry| entry.is_finite()) {
        return Err(SlamError::NotFinite { what });
    }
    let tolerance = 1e-9 * matrix.amax(); // entries that were computed with rounding
    let asymmetry = (matrix - matrix.transpose()).amax();
    let value = if is_diagonal(matrix) { matrix.diagonal().min() } else { matrix.symmetric_eigenvalues().min() };
    if asymmetry > tolerance || value < -tolerance {
        return Err(SlamError::NotACovariance { what, value, asymmetry });
    }
    Ok(())
}

/// The usual case, for which no eigenvalue needs to be iterated.
fn is_diagonal(matrix: &Matrix3<f64>) -> bool {
    (0..9).all(|i| i % 4 == 0 || matrix[i] == 0.0)
}
