use nalgebra::{DefaultAllocator, Dim, OMatrix, OVector, RealField};
use wayfix_estimation_traits::{MotionModel, StateAlloc};

use crate::{KalmanError, certificate::MotionCertificate, check};

/// $`x_k = F x_{k-1} + u_k + w_k,\; w_k ∼ N(0, Q)`$ with constant $`F`$ and $`Q`$, checked once.
///
/// The control is the displacement $`u`$ in state space (multiply your $`B u`$ first); pass `None` for free motion.
///
/// ```
/// use nalgebra::Matrix2;
/// use wayfix_kalman::LinearMotion;
/// let constant_velocity = Matrix2::new(1.0, 0.1, 0.0, 1.0);
/// assert!(LinearMotion::new(constant_velocity, Matrix2::identity() * 0.01).is_ok());
/// assert!(LinearMotion::new(constant_velocity, Matrix2::new(1.0, 2.0, 2.0, 1.0)).is_err()); // indefinite
/// ```
#[derive(Clone, Debug, PartialEq)]
pub struct LinearMotion<T: RealField + Copy, D: Dim>
where
    DefaultAllocator: StateAlloc<D>,
{
    transition: OMatrix<T, D, D>,
    noise: OMatrix<T, D, D>,
    certificate: MotionCertificate<T>,
}

impl<T: RealField + Copy, D: Dim> LinearMotion<T, D>
where
    DefaultAllocator: StateAlloc<D>,
{
    /// Transition matrix $`F`$ and noise $`Q`$ (positive semidefinite).
    ///
    /// # Errors
    /// Returns an error if sizes do not match, an entry is not finite, or $`Q`$ is not symmetric positive semidefinite.
    pub fn new(transition: OMatrix<T, D, D>, mut noise: OMatrix<T, D, D>) -> Result<Self, KalmanError> {
        let n = transition.nrows();
        check::dimension("transition matrix", n, transition.ncols())?;
        check::finite("transition matrix", &transition)?;
        check::motion_noise(&noise, n)?;
        noise.fill_upper_triangle_with_lower_triangle();
        let certificate = MotionCertificate::new(&transition, &noise);
        Ok(Self { transition, noise, certificate })
    }

    /// A random walk: $`F = I`$.
    ///
    /// # Errors
    /// As [`new`](Self::new).
    pub fn stationary(noise: OMatrix<T, D, D>) -> Result<Self, KalmanError> {
        let (n, _) = noise.shape_generic();
        Self::new(OMatrix::identity_generic(n, n), noise)
    }

    /// $`F`$.
    pub fn transition(&self) -> &OMatrix<T, D, D> {
        &self.transition
    }
    /// $`Q`$.
    pub fn noise(&self) -> &OMatrix<T, D, D> {
        &self.noise
    }
    pub(crate) fn certificate(&self) -> &MotionCertificate<T> {
        &self.certificate
    }
}

impl<T: RealField + Copy, D: Dim> MotionModel for LinearMotion<T, D>
where
    DefaultAllocator: StateAlloc<D>,
{
    type State = OVector<T, D>;
    type Control = Option<OVector<T, D>>;

    fn propagate(&self, state: &OVector<T, D>, control: &Option<OVector<T, D>>) -> OVector<T, D> {
        let moved = &self.transition * state;
        match control {
            // A displacement of the wrong size cannot be added; the filter refuses the NaN.
            Some(displacement) if displacement.nrows() != moved.nrows() => moved * T::zero() / T::zero(),
            Some(displacement) => moved + displacement,
            None => moved,
        }
    }
    fn jacobian(&self, _: &OVector<T, D>, _: &Option<OVector<T, D>>) -> OMatrix<T, D, D> {
        self.transition.clone()
    }
    fn noise(&self, _: &OVector<T, D>, _: &Option<OVector<T, D>>) -> OMatrix<T, D, D> {
        self.noise.clone()
    }
}
