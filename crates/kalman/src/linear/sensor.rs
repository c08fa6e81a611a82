use nalgebra::{DefaultAllocator, Dim, OMatrix, OVector, RealField};
use wayfix_estimation_traits::{Manifold, SensorModel, UpdateAlloc};

use crate::{KalmanError, certificate::SensorCertificate, check};

/// $`z = H x + v,\; v ∼ N(0, R)`$ with constant $`H`$ and $`R`$, checked once.
///
/// The parameters are the vector types of state and measurement, inferred from the matrices.
///
/// ```
/// use nalgebra::{Matrix1, Matrix1x2};
/// use wayfix_kalman::LinearSensor;
/// let position = LinearSensor::new(Matrix1x2::new(1.0, 0.0), Matrix1::new(0.25))?;
/// assert_eq!(position.matrix()[(0, 0)], 1.0);
/// assert!(LinearSensor::new(Matrix1x2::new(1.0, 0.0), Matrix1::new(0.0)).is_err()); // a perfect sensor is not a sensor
/// # Ok::<(), wayfix_kalman::KalmanError>(())
/// ```
#[derive(Clone, Debug, PartialEq)]
pub struct LinearSensor<X: Manifold, Z: Manifold<Scalar = X::Scalar>>
where
    DefaultAllocator: UpdateAlloc<X::Dim, Z::Dim>,
{
    matrix: OMatrix<X::Scalar, Z::Dim, X::Dim>,
    noise: OMatrix<X::Scalar, Z::Dim, Z::Dim>,
    certificate: SensorCertificate<X::Scalar>,
}

impl<T: RealField + Copy, D: Dim, M: Dim> LinearSensor<OVector<T, D>, OVector<T, M>>
where
    DefaultAllocator: UpdateAlloc<D, M>,
{
    /// Measurement matrix $`H`$ and noise $`R`$ (positive definite).
    ///
    /// # Errors
    /// Returns an error if sizes do not match, an entry is not finite, or $`R`$ is not symmetric positive definite.
    pub fn new(matrix: OMatrix<T, M, D>, mut noise: OMatrix<T, M, M>) -> Result<Self, KalmanError> {
        check::finite("measurement matrix", &matrix)?;
        check::sensor_noise(&noise, matrix.nrows())?;
        noise.fill_upper_triangle_with_lower_triangle();
        let certificate = SensorCertificate::new(&matrix, &noise);
        Ok(Self { matrix, noise, certificate })
    }

    /// $`H`$.
    pub fn matrix(&self) -> &OMatrix<T, M, D> {
        &self.matrix
    }
    /// $`R`$.
    pub fn noise(&self) -> &OMatrix<T, M, M> {
        &self.noise
    }
    pub(crate) fn certificate(&self) -> &SensorCertificate<T> {
        &self.certificate
    }
}

impl<T: RealField + Copy, D: Dim, M: Dim> SensorModel for LinearSensor<OVector<T, D>, OVector<T, M>>
where
    DefaultAllocator: UpdateAlloc<D, M>,
{
    type State = OVector<T, D>;
    type Measurement = OVector<T, M>;

    fn expected(&self, state: &OVector<T, D>) -> OVector<T, M> {
        let (m, n) = self.matrix.shape_generic();
        if state.nrows() == n.value() {
            &self.matrix * state
        } else {
            // A state of another size is invalid for this sensor; the filter refuses the NaN.
            OVector::from_element_generic(m, nalgebra::Const::<1>, T::zero() / T::zero())
        }
    }
    fn jacobian(&self, _: &OVector<T, D>) -> OMatrix<T, M, D> {
        self.matrix.clone()
    }
    fn noise(&self, _: &OVector<T, D>) -> OMatrix<T, M, M> {
        self.noise.clone()
    }
}
