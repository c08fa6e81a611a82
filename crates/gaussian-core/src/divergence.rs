use nalgebra::{DefaultAllocator, Dim};
use wayfix_estimation_traits::{Manifold, StateAlloc, to_f64};

use crate::{Gaussian, GaussianError, cholesky, density::NormalTerms};

impl<X: Manifold> Gaussian<X>
where
    DefaultAllocator: StateAlloc<X::Dim>,
{
    /// The Kullback-Leibler divergence $`D(p \| q)`$ of this $`p`$ from `other` $`q`$, in nats.
    ///
    /// $`\tfrac12 \big(\mathrm{tr}(Σ_q^{-1} Σ_p) + δ^T Σ_q^{-1} δ - n + \log\det Σ_q / \det Σ_p\big)`$, on manifolds in the tangent space at the
    /// mean of $`q`$. Not symmetric. [Kullback & Leibler 1951]
    ///
    /// ```
    /// use nalgebra::Vector1;
    /// use wayfix_gaussian_core::Gaussian;
    /// let p = Gaussian::from_sigmas(Vector1::new(0.0), &Vector1::new(1.0))?;
    /// let q = Gaussian::from_sigmas(Vector1::new(1.0), &Vector1::new(1.0))?;
    /// assert!((p.kl_divergence(&q)? - 0.5_f64).abs() < 1e-15);
    /// # Ok::<(), wayfix_gaussian_core::GaussianError>(())
    /// ```
    ///
    /// # Errors
    /// Returns an error if dimensions differ or a covariance (unchecked) is not positive definite.
    pub fn kl_divergence(&self, other: &Self) -> Result<f64, GaussianError> {
        let (deviation, own) = self.in_chart_at(other.mean())?.into_parts();
        let theirs = NormalTerms::new("other", &deviation, other.covariance())?;
        let own_log_determinant = to_f64(cholesky("own", &own)?.ln_determinant());
        let trace = to_f64(cholesky("other", other.covariance())?.solve(&own).trace());
        let dimension = self.dim().value() as f64;
        Ok(0.5 * (trace - dimension + theirs.squared_distance + theirs.log_determinant - own_log_determinant))
    }

    /// The Bhattacharyya distance in nats: 0 for equal Gaussians, symmetric in the two.
    ///
    /// $`\tfrac18 δ^T \bar Σ^{-1} δ + \tfrac12 \log\big(\det \bar Σ / \sqrt{\det Σ_1 \det Σ_2}\big)`$, $`\bar Σ = (Σ_1 + Σ_2)/2`$, on manifolds in the
    /// tangent space half way between the means. [Kailath 1967]
    ///
    /// ```
    /// use nalgebra::Vector1;
    /// use wayfix_gaussian_core::Gaussian;
    /// let p = Gaussian::from_sigmas(Vector1::new(0.0), &Vector1::new(1.0))?;
    /// let q = Gaussian::from_sigmas(Vector1::new(2.0), &Vector1::new(1.0))?;
    /// assert!((p.bhattacharyya_distance(&q)? - 0.5_f64).abs() < 1e-15);
    /// # Ok::<(), wayfix_gaussian_core::GaussianError>(())
    /// ```
    ///
    /// # Errors
    /// As for [`kl_divergence`](Self::kl_divergence).
    pub fn bhattacharyya_distance(&self, other: &Self) -> Result<f64, GaussianError> {
        let half = nalgebra::convert::<f64, X::Scalar>(0.5);
        crate::gaussian::check_dimension("other", self.dim().value(), other.dim().value())?;
        let between = self.mean().retract(&(self.mean().local(other.mean()) * half));
        let (m1, p1) = self.in_chart_at(&between)?.into_parts();
        let (m2, p2) = other.in_chart_at(&between)?.into_parts();
        let joint = NormalTerms::new("mean", &(m2 - m1), &((&p1 + &p2) * half))?;
        let log_determinants =
            to_f64(cholesky("own", &p1)?.ln_determinant()) + to_f64(cholesky("other", &p2)?.ln_determinant());
        Ok(0.125 * joint.squared_distance + 0.5 * (joint.log_determinant - 0.5 * log_determinants))
    }
}
