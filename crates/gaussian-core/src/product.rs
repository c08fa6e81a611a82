use nalgebra::{ComplexField, DefaultAllocator, Dim, OMatrix, OVector, RealField, allocator::Allocator};
use wayfix_estimation_traits::{Manifold, StateAlloc, Tangent, TangentMatrix, epsilon, to_f64};

use crate::{Gaussian, GaussianError, IterationError, cholesky, symmetrize};

const MAX_ITERATIONS: usize = 50;

impl<X: Manifold> Gaussian<X>
where
    DefaultAllocator: StateAlloc<X::Dim>,
{
    /// The normalized product of two densities: two **independent** estimates fused, weighted by information.
    ///
    /// $`Σ^{-1} = Σ_1^{-1} + Σ_2^{-1}`$, $`Σ^{-1} μ = Σ_1^{-1} μ_1 + Σ_2^{-1} μ_2`$. Exact for vectors; on other manifolds Gauss-Newton
    /// towards the most probable point, where the covariance then lives.
    /// For estimates that may share information see [`covariance_intersection`](crate::covariance_intersection).
    ///
    /// ```
    /// use nalgebra::Vector1;
    /// use wayfix_gaussian_core::Gaussian;
    /// let rough = Gaussian::from_sigmas(Vector1::new(0.0), &Vector1::new(2.0))?;
    /// let sharp = Gaussian::from_sigmas(Vector1::new(5.0), &Vector1::new(1.0))?;
    /// let fused = rough.product(&sharp)?;
    /// assert!((fused.mean()[0] - 4.0_f64).abs() < 1e-15 && (fused.covariance()[(0, 0)] - 0.8).abs() < 1e-15);
    /// # Ok::<(), Box<dyn std::error::Error>>(())
    /// ```
    ///
    /// # Errors
    /// Returns an error if dimensions differ, a covariance (unchecked) is not positive definite, or two estimates contradict each other across
    /// half the manifold so that no mode is found.
    pub fn product(&self, other: &Self) -> Result<Self, IterationError<X>> {
        relinearized("product", self.mean().clone(), |at| {
            let (first, second) = (self.in_chart_at(at)?, other.in_chart_at(at)?);
            fused(first.into_parts(), second.into_parts())
        })
    }
}

type Parts<T, D> = (OVector<T, D>, OMatrix<T, D, D>);

/// The product of vector Gaussians; the covariance in Joseph form stays positive definite under rounding.
fn fused<T: RealField + Copy, D: Dim>(
    (m1, p1): Parts<T, D>,
    (m2, p2): Parts<T, D>,
) -> Result<Parts<T, D>, GaussianError>
where
    DefaultAllocator: Allocator<D> + Allocator<D, D>,
{
    let gain = cholesky("sum", &(&p1 + &p2))?.solve(&p1).transpose();
    let (n, _) = m1.shape_generic();
    let kept = OMatrix::identity_generic(n, n) - &gain;
    let mut covariance = &kept * p1 * kept.transpose() + &gain * p2 * gain.transpose();
    symmetrize(&mut covariance);
    let mean = &m1 + gain * (m2 - &m1);
    Ok((mean, covariance))
}

/// Moves to the mean that `parts` finds in the chart at the current point, until it finds it there.
pub(crate) fn relinearized<X: Manifold>(
    what: &'static str,
    start: X,
    parts: impl Fn(&X) -> Result<(Tangent<X>, TangentMatrix<X>), GaussianError>,
) -> Result<Gaussian<X>, IterationError<X>>
where
    DefaultAllocator: StateAlloc<X::Dim>,
{
    let mut at = start;
    let mut last_step = X::Scalar::from_real(nalgebra::zero());
    // A thousandth of what rounding in half the digits is to a sigma; Gauss-Newton gets there in a few steps.
    let tolerance = epsilon::<X::Scalar>().sqrt();
    for _ in 0..MAX_ITERATIONS {
        let (step, covariance) = parts(&at)?;
        if !step.iter().all(ComplexField::is_finite) {
            return Err(GaussianError::NotFinite { what }.into());
        }
        at = at.retract(&step);
        let small = step.iter().enumerate().all(|(i, s)| s.abs() <= covariance[(i, i)].sqrt() * tolerance);
        if small {
            return Ok(Gaussian::from_parts_unchecked(at, covariance));
        }
        last_step = step.norm();
    }
    Err(IterationError::NotConverged { what, last: at, iterations: MAX_ITERATIONS, step: to_f64(last_step) })
}
