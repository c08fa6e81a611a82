use nalgebra::{DMatrix, DefaultAllocator, DimName, OMatrix, allocator::Allocator};
use wayfix_estimation_traits::{Manifold, MotionModel, Tangent, TangentMatrix};

use super::{EkfSlam, state::is_finite};
use crate::{LandmarkDim, LandmarkModel, MeasurementDim, RobotDim, RobotState, SlamAlloc, SlamError};

impl<M: LandmarkModel> EkfSlam<M>
where
    DefaultAllocator: SlamAlloc<RobotDim<M>, LandmarkDim<M>, MeasurementDim<M>>,
{
    /// Moves the robot: $`x_r ← f(x_r, u),\; P_{rr} ← F P_{rr} F^T + Q,\; P_{rm} ← F P_{rm}`$. Cost O(n).
    ///
    /// # Errors
    /// When the model gives anything that is not finite or a noise that is no covariance; nothing has changed then.
    pub fn predict<U: ?Sized>(
        &mut self,
        motion: &impl MotionModel<State = M::Robot, Control = U>,
        control: &U,
    ) -> Result<(), SlamError> {
        let moved = motion.propagate(&self.robot, control);
        let (jacobian, noise) = (motion.jacobian(&self.robot, control), motion.noise(&self.robot, control));
        if !is_finite(&moved) {
            return Err(SlamError::NotFinite { what: "propagated robot state" });
        }
        if !jacobian.iter().all(|entry| entry.is_finite()) {
            return Err(SlamError::NotFinite { what: "motion Jacobian" });
        }
        check_covariance("motion noise", &noise)?;

        let predicted = &jacobian * self.robot_covariance() * jacobian.transpose() + &noise;
        if !predicted.iter().all(|entry| entry.abs() < LARGEST_VARIANCE) {
            return Err(SlamError::NotFinite { what: "predicted covariance" });
        }
        self.covariance.move_robot(&jacobian, &noise);
        self.robot = moved;
        Ok(())
    }

    /// Steps the robot's mean and takes its covariance along into the tangent space there.
    pub(super) fn step_robot(&mut self, step: &Tangent<M::Robot>) {
        let transport = self.robot.transport(step);
        self.robot = self.robot.retract(step);
        self.covariance.move_robot(&transport, &TangentMatrix::<M::Robot>::zeros());
    }
}

/// Beyond this a variance says nothing (1e15 km²) and its products would overflow.
const LARGEST_VARIANCE: f64 = 1e36;

/// Refuses what is not symmetric positive semidefinite; zero variances are fine.
pub(super) fn check_covariance<D: DimName>(
    what: &'static str,
    matrix: &OMatrix<f64, D, D>,
) -> Result<(), SlamError>
where
    DefaultAllocator: Allocator<D, D>,
{
    if !matrix.iter().all(|entry| entry.is_finite()) {
        return Err(SlamError::NotFinite { what });
    }
    let tolerance = 1e-9 * matrix.amax(); // entries that were computed with rounding
    let asymmetry = (matrix - matrix.transpose()).amax();
    let value = smallest_eigenvalue(matrix);
    if asymmetry > tolerance || value < -tolerance {
        return Err(SlamError::NotACovariance { what, value, asymmetry });
    }
    Ok(())
}

/// Nothing to iterate in the usual case of a diagonal matrix.
fn smallest_eigenvalue<D: DimName>(matrix: &OMatrix<f64, D, D>) -> f64
where
    DefaultAllocator: Allocator<D, D>,
{
    let diagonal = || (0..D::DIM).map(|i| matrix[(i, i)]);
    let off_diagonal = matrix.norm_squared() - diagonal().map(|entry| entry * entry).sum::<f64>();
    if off_diagonal == 0.0 {
        return diagonal().fold(f64::INFINITY, f64::min);
    }
    DMatrix::from_fn(D::DIM, D::DIM, |row, column| matrix[(row, column)]).symmetric_eigenvalues().min()
}
