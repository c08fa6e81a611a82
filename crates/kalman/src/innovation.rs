use nalgebra::{ComplexField, DefaultAllocator, OMatrix, linalg::Cholesky};
use wayfix_estimation_traits::{LogWeight, Manifold, Tangent, TangentMatrix, UpdateAlloc, to_f64};
use wayfix_gaussian_core::check_covariance;

use crate::{
    algebra::ldl::Ldl,
    algebra::product::{times, times_transpose},
    check,
    error::Checked,
};

/// The innovation of a measurement: the input of gates, plots, likelihoods and consistency tests.
///
/// $`y = z ⊟ h(x)`$ with covariance $`S`$ and cross-covariance $`C = \mathrm{cov}(x, z)`$ (which is $`P H^T`$ for a linearized sensor),
/// always relative to the *predicted* state. [Bar-Shalom et al. 2001, §5.2.3]
///
/// ```
/// use nalgebra::{Matrix1, Matrix1x2, Matrix2, Vector1, Vector2};
/// use wayfix_gaussian_core::Gaussian;
/// use wayfix_kalman::{KalmanFilter, LinearMotion, LinearSensor};
/// let prior = Gaussian::new(Vector2::new(0.0, 0.0), Matrix2::identity() * 3.0)?;
/// let mut filter = KalmanFilter::new(LinearMotion::stationary(Matrix2::zeros())?, prior)?;
/// let sensor = LinearSensor::new(Matrix1x2::new(1.0, 0.0), Matrix1::new(1.0))?;
/// let innovation = filter.update(&sensor, &Vector1::new(2.0))?;
/// assert_eq!(innovation.residual()[0], 2.0);
/// assert_eq!(innovation.covariance()[0], 4.0);         // 3 of the prior + 1 of the sensor
/// assert_eq!(innovation.nis(), 1.0);                   // 2² / 4
/// assert_eq!(innovation.gain()[0], 0.75);              // 3 / 4
/// # Ok::<(), wayfix_kalman::KalmanError>(())
/// ```
#[derive(Clone, Debug)]
pub struct Innovation<X: Manifold, Z: Manifold<Scalar = X::Scalar>>
where
    DefaultAllocator: UpdateAlloc<X::Dim, Z::Dim>,
{
    residual: Tangent<Z>,
    covariance: TangentMatrix<Z>,
    cross_covariance: OMatrix<X::Scalar, X::Dim, Z::Dim>,
    ldl: Ldl<X::Scalar, Z::Dim>,
}

impl<X: Manifold, Z: Manifold<Scalar = X::Scalar>> Innovation<X, Z>
where
    DefaultAllocator: UpdateAlloc<X::Dim, Z::Dim>,
{
    /// An innovation from its three parts.
    ///
    /// # Errors
    /// Returns an error if the sizes do not match, a part is not finite, or the covariance is not positive definite.
    pub fn new(
        residual: Tangent<Z>,
        covariance: TangentMatrix<Z>,
        cross_covariance: OMatrix<X::Scalar, X::Dim, Z::Dim>,
    ) -> Checked<Self> {
        let m = residual.nrows();
        check::shape("innovation covariance", (m, m), covariance.shape())?;
        check_covariance("innovation", &covariance)?;
        let ldl = Ldl::new(&covariance).ok_or_else(|| check::refused("innovation", &covariance))?;
        Self::factored(residual, covariance, cross_covariance, ldl)
    }

    /// With the factorization of the covariance at hand.
    pub(crate) fn factored(
        residual: Tangent<Z>,
        covariance: TangentMatrix<Z>,
        cross_covariance: OMatrix<X::Scalar, X::Dim, Z::Dim>,
        ldl: Ldl<X::Scalar, Z::Dim>,
    ) -> Checked<Self> {
        check::dimension("cross-covariance", residual.nrows(), cross_covariance.ncols())?;
        check::finite("residual", &residual)?;
        check::finite("cross-covariance", &cross_covariance)?;
        Ok(Self { residual, covariance, cross_covariance, ldl })
    }

    /// $`y = z ⊟ h(x)`$.
    pub fn residual(&self) -> &Tangent<Z> {
        &self.residual
    }
    /// $`S`$, the covariance of the residual.
    pub fn covariance(&self) -> &TangentMatrix<Z> {
        &self.covariance
    }
    /// $`C = \mathrm{cov}(x, z)`$, state by measurement.
    pub fn cross_covariance(&self) -> &OMatrix<X::Scalar, X::Dim, Z::Dim> {
        &self.cross_covariance
    }
    /// The Cholesky factorization $`G G^T = S`$, for solving with $`S`$.
    pub fn factor(&self) -> Cholesky<X::Scalar, Z::Dim> {
        Cholesky::pack_dirty(self.ldl.root())
    }
    /// Dimension of the measurement: degrees of freedom of [`nis`](Self::nis).
    pub fn dim(&self) -> usize {
        self.residual.nrows()
    }

    /// The Kalman gain $`K = C S^{-1}`$, by solving.
    #[inline(always)]
    pub fn gain(&self) -> OMatrix<X::Scalar, X::Dim, Z::Dim> {
        let mut gain = self.cross_covariance.clone();
        self.ldl.divide(&mut gain);
        gain
    }

    /// The normalized innovation squared $`y^T S^{-1} y`$, chi-squared with [`dim`](Self::dim) degrees of freedom for a consistent filter.
    pub fn nis(&self) -> f64 {
        to_f64(self.whitened().norm_squared())
    }

    /// $`\ln N(y; 0, S)`$, nats. [Andrade-Cetto 2005, Eq. 11]
    pub fn log_likelihood(&self) -> LogWeight {
        let log_determinant: f64 = (0..self.dim()).map(|k| -to_f64(self.ldl.inverse_pivot(k)).ln()).sum();
        -0.5 * (self.nis() + self.dim() as f64 * std::f64::consts::TAU.ln() + log_determinant)
    }

    /// $`D^{-1/2} L^{-1} y`$ with $`L D L^T = S`$: independent unit normal components for a consistent filter.
    pub fn whitened(&self) -> Tangent<Z> {
        let mut whitened = self.residual.clone();
        self.ldl.whiten(&mut whitened);
        for k in 0..whitened.nrows() {
            whitened[k] *= ComplexField::sqrt(self.ldl.inverse_pivot(k));
        }
        whitened
    }

    /// $`C = P H^T,\; S = H C + R`$ of a linearized sensor.
    #[inline(always)]
    pub(crate) fn of_linearized(
        residual: Tangent<Z>,
        prior: &TangentMatrix<X>,
        jacobian: &OMatrix<X::Scalar, Z::Dim, X::Dim>,
        noise: &TangentMatrix<Z>,
    ) -> Checked<Self> {
        let cross_covariance = times_transpose(prior, jacobian);
        let mut covariance = times(jacobian, &cross_covariance);
        covariance += noise;
        match Ldl::new(&covariance) {
            Some(ldl) => Ok(Self { residual, covariance, cross_covariance, ldl }),
            None => Err(check::refused("innovation", &covariance)),
        }
    }
}
