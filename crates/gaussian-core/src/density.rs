use nalgebra::{DefaultAllocator, Dim, OMatrix, OVector, RealField, allocator::Allocator};
use wayfix_estimation_traits::{LogWeight, Manifold, StateAlloc, to_f64};

use crate::{Gaussian, GaussianError, cholesky, gaussian::check_dimension};

impl<X: Manifold> Gaussian<X>
where
    DefaultAllocator: StateAlloc<X::Dim>,
{
    /// The squared Mahalanobis distance $`d^2 = δ^T Σ^{-1} δ`$ of `point`, with $`δ = x ⊟ μ`$.
    ///
    /// Chi-squared with as many degrees of freedom as the state has, when `point` is drawn from here: see
    /// [`ChiSquaredGate`](crate::ChiSquaredGate).
    ///
    /// ```
    /// use nalgebra::Vector2;
    /// use wayfix_gaussian_core::Gaussian;
    /// let gaussian = Gaussian::from_sigmas(Vector2::new(0.0, 0.0), &Vector2::new(2.0, 1.0))?;
    /// assert!((gaussian.mahalanobis_squared(&Vector2::new(2.0, 1.0))? - 2.0_f64).abs() < 1e-15);
    /// # Ok::<(), wayfix_gaussian_core::GaussianError>(())
    /// ```
    ///
    /// # Errors
    /// Returns an error if `point` is not finite or of another dimension, or the covariance (unchecked) is not positive definite.
    pub fn mahalanobis_squared(&self, point: &X) -> Result<f64, GaussianError> {
        Ok(self.normal_terms(point)?.squared_distance)
    }

    /// $`\log N(x; μ, Σ) = -\tfrac12 (d^2 + \log\det Σ + n \log 2π)`$ in nats.
    ///
    /// Density over the tangent space at the mean.
    ///
    /// ```
    /// use nalgebra::Vector1;
    /// use wayfix_gaussian_core::Gaussian;
    /// let standard = Gaussian::from_sigmas(Vector1::new(0.0), &Vector1::new(1.0))?;
    /// assert!((standard.density(&Vector1::new(1.0))? - 0.24197072451914337).abs() < 1e-16); // scipy.stats.norm.pdf(1)
    /// assert!((standard.log_density(&Vector1::new(100.0))? + 5000.9189385332047).abs() < 1e-9);
    /// # Ok::<(), wayfix_gaussian_core::GaussianError>(())
    /// ```
    ///
    /// # Errors
    /// As for [`mahalanobis_squared`](Self::mahalanobis_squared).
    pub fn log_density(&self, point: &X) -> Result<LogWeight, GaussianError> {
        Ok(self.normal_terms(point)?.log_density())
    }

    /// $`N(x; μ, Σ)`$; underflows to 0 far out, where [`log_density`](Self::log_density) does not.
    ///
    /// # Errors
    /// As for [`mahalanobis_squared`](Self::mahalanobis_squared).
    pub fn density(&self, point: &X) -> Result<f64, GaussianError> {
        self.log_density(point).map(f64::exp)
    }

    fn normal_terms(&self, point: &X) -> Result<NormalTerms, GaussianError> {
        check_dimension("point", self.dim().value(), point.dim().value())?;
        NormalTerms::new("density", &self.mean().local(point), self.covariance())
    }
}

/// The common terms of all Gaussian formulas, from one factorization.
pub(crate) struct NormalTerms {
    pub(crate) squared_distance: f64,
    pub(crate) log_determinant: f64,
    dimension: usize,
}

impl NormalTerms {
    pub(crate) fn new<T: RealField + Copy, D: Dim>(
        what: &'static str,
        deviation: &OVector<T, D>,
        covariance: &OMatrix<T, D, D>,
    ) -> Result<Self, GaussianError>
    where
        DefaultAllocator: Allocator<D> + Allocator<D, D>,
    {
        if !deviation.iter().all(|entry| entry.is_finite()) {
            return Err(GaussianError::NotFinite { what: "deviation" });
        }
        let factor = cholesky(what, covariance)?;
        let mut whitened = deviation.clone();
        // The diagonal of a Cholesky factor is positive, so this cannot fail.
        factor.l_dirty().solve_lower_triangular_mut(&mut whitened);
        Ok(Self {
            squared_distance: to_f64(whitened.norm_squared()),
            log_determinant: to_f64(factor.ln_determinant()),
            dimension: deviation.len(),
        })
    }

    pub(crate) fn log_density(&self) -> LogWeight {
        let log_two_pi = (2.0 * std::f64::consts::PI).ln();
        -0.5 * (self.squared_distance + self.log_determinant + self.dimension as f64 * log_two_pi)
    }
}
