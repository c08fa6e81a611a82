use nalgebra::DefaultAllocator;
use wayfix_estimation_traits::{Manifold, StateAlloc, Tangent};

use crate::{Gaussian, GaussianError, gaussian::check_dimension, symmetrize};

impl<X: Manifold> Gaussian<X>
where
    DefaultAllocator: StateAlloc<X::Dim>,
{
    /// This Gaussian as a vector Gaussian in the tangent space at `at`, to first order.
    ///
    /// $`N(μ ⊟ y,\; J Σ J^T)`$ with $`J = ∂((μ ⊞ δ) ⊟ y)/∂δ`$. Gaussians in one tangent space add, fuse and compare like vectors.
    ///
    /// ```
    /// use nalgebra::Vector3;
    /// use wayfix_estimation_traits::Pose2;
    /// use wayfix_gaussian_core::Gaussian;
    /// let facing_left = Pose2::<f64>::new(1.0, 0.0, std::f64::consts::FRAC_PI_2);
    /// let belief = Gaussian::from_sigmas(facing_left, &Vector3::new(0.2, 0.1, 0.01))?;
    /// let seen = belief.in_chart_at(&Pose2::new(0.0, 0.0, 0.0))?;
    /// assert!((seen.mean().x - 1.0).abs() < 1e-15);
    /// assert!((seen.covariance()[(1, 1)] - 0.04).abs() < 1e-15); // forward of the body is left of the world
    /// # Ok::<(), wayfix_gaussian_core::GaussianError>(())
    /// ```
    ///
    /// # Errors
    /// Returns an error if dimensions differ.
    pub fn in_chart_at(&self, at: &X) -> Result<Gaussian<Tangent<X>>, GaussianError> {
        use nalgebra::Dim;
        check_dimension("chart", self.dim().value(), at.dim().value())?;
        let jacobian = self.mean().chart_jacobian(at);
        let mut covariance = &jacobian * self.covariance() * jacobian.transpose();
        symmetrize(&mut covariance);
        Ok(Gaussian::from_parts_unchecked(at.local(self.mean()), covariance))
    }
}
