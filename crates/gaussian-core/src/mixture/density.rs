use nalgebra::DefaultAllocator;
use wayfix_estimation_traits::{LogWeight, Manifold, StateAlloc};

use super::{GaussianMixture, log_sum_exp};
use crate::{Gaussian, GaussianError, IterationError, moment_matched};

impl<X: Manifold> GaussianMixture<X>
where
    DefaultAllocator: StateAlloc<X::Dim>,
{
    /// $`\log \sum_i w_i N(x; μ_i, Σ_i)`$ in nats; finite far out, where the density itself underflows.
    ///
    /// ```
    /// use nalgebra::Vector1;
    /// use wayfix_gaussian_core::{Gaussian, GaussianMixture};
    /// let standard = Gaussian::from_sigmas(Vector1::new(0.0_f64), &Vector1::new(1.0))?;
    /// let mixture = GaussianMixture::from_weights(vec![(2.0, standard.clone()), (1.0, standard.clone())])?;
    /// let far = Vector1::new(1e3);
    /// assert!((mixture.log_density(&far)? - standard.log_density(&far)?).abs() < 1e-9);
    /// # Ok::<(), wayfix_gaussian_core::GaussianError>(())
    /// ```
    ///
    /// # Errors
    /// Those of [`Gaussian::log_density`].
    pub fn log_density(&self, point: &X) -> Result<LogWeight, GaussianError> {
        let terms: Result<Vec<_>, _> = (self.components.iter().zip(&self.log_weights))
            .map(|(component, log_weight)| component.log_density(point).map(|density| log_weight + density))
            .collect();
        Ok(log_sum_exp(&terms?))
    }

    /// The one Gaussian with the same mean and covariance.
    ///
    /// # Errors
    /// When the components are spread all round a manifold and have no mean.
    pub fn moments(&self) -> Result<Gaussian<X>, IterationError<X>> {
        moment_matched(&self.weights(), &self.components)
    }
}
