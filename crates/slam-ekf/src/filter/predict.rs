use nalgebra::{DMatrix, DefaultAllocator, DimName, OMatrix, allocator::Allocator};
use wayfix_estimation_traits::MotionModel;

use super::{EkfSlam, state::is_finite};
use crate::{LandmarkDim, LandmarkModel, MeasurementDim, RobotDim, SlamAlloc, SlamError};

impl<M: LandmarkModel> EkfSlam<M>
where
    DefaultAllocator: SlamAlloc<RobotDim<M>, LandmarkDim<M>, MeasurementDim<M>>,
{
    /// Moves the robot: $`x_r ← f(x_r, u),\; P_{rr} ← F P_{rr} F^T + Q,\; P_{rm} ← F P_{rm}`$. Cost O(n). [Andrade-Cetto 2005, Eqs. 1, 3, 5]
    ///
    /// # Errors
    /// Returns an error if the model returns a non-finite value or an invalid noise covariance; the filter is then unchanged.
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
}

/// Upper bound of a variance (1e15 km²); products of larger ones would overflow.
pub(super) const LARGEST_VARIANCE: f64 = 1e36;

/// Refuses matrices that are not symmetric positive semidefinite; zero variances are valid. The rounding tolerance applies to correlations:
/// a variance in square kilometres does not hide a negative one in square millimetres.
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
    let asymmetry = (matrix - matrix.transpose()).amax();
    let smallest_variance = (0..D::DIM).map(|i| matrix[(i, i)]).fold(f64::INFINITY, f64::min);
    if smallest_variance < 0.0 {
        return Err(SlamError::NotACovariance { what, value: smallest_variance, asymmetry });
    }
    let correlations = correlations(matrix);
    let lopsided = (&correlations - correlations.transpose()).amax();
    let value = smallest_eigenvalue(&correlations);
    // Infinite correlations, of coordinates with zero variance, fail both.
    if lopsided <= 1e-9 && value >= -1e-12 {
        Ok(())
    } else {
        Err(SlamError::NotACovariance { what, value, asymmetry })
    }
}

/// $`ρ_{ij} = P_{ij} / \sqrt{P_{ii} P_{jj}}`$, and 0 for 0/0.
fn correlations<D: DimName>(matrix: &OMatrix<f64, D, D>) -> OMatrix<f64, D, D>
where
    DefaultAllocator: Allocator<D, D>,
{
    let deviation = |i: usize| matrix[(i, i)].sqrt();
    OMatrix::from_fn(|row, column| match matrix[(row, column)] {
        0.0 => 0.0,
        covariance => covariance / deviation(row) / deviation(column),
    })
}

/// A diagonal matrix, the most frequent case, needs no iteration.
fn smallest_eigenvalue<D: DimName>(matrix: &OMatrix<f64, D, D>) -> f64
where
    DefaultAllocator: Allocator<D, D>,
{
    let entries = || (0..D::DIM).flat_map(|row| (0..D::DIM).map(move |column| (row, column)));
    if entries().all(|(row, column)| row == column || matrix[(row, column)] == 0.0) {
        return entries().map(|(i, _)| matrix[(i, i)]).fold(f64::INFINITY, f64::min);
    }
    if !matrix.iter().all(|entry| entry.is_finite()) {
        return f64::NAN;
    }
    DMatrix::from_fn(D::DIM, D::DIM, |row, column| matrix[(row, column)]).symmetric_eigenvalues().min()
}

/// The error of a symmetric matrix that has no Cholesky factor.
pub(super) fn not_positive_definite(what: &'static str, matrix: &DMatrix<f64>) -> SlamError {
    if !matrix.iter().all(|entry| entry.is_finite()) {
        return SlamError::NotFinite { what };
    }
    SlamError::NotACovariance { what, value: matrix.symmetric_eigenvalues().min(), asymmetry: 0.0 }
}
