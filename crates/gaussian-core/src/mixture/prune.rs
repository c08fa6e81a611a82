use nalgebra::DefaultAllocator;
use wayfix_estimation_traits::{Manifold, StateAlloc};

use super::GaussianMixture;
use crate::GaussianError;

impl<X: Manifold> GaussianMixture<X>
where
    DefaultAllocator: StateAlloc<X::Dim>,
{
    /// Drops components of weight below `least`, and normalizes.
    ///
    /// ```
    /// use nalgebra::Vector1;
    /// use wayfix_gaussian_core::{Gaussian, GaussianMixture};
    /// let at = |x: f64| Gaussian::from_sigmas(Vector1::new(x), &Vector1::new(1.0));
    /// let mixture = GaussianMixture::from_weights(vec![(0.7, at(0.0)?), (0.2, at(1.0)?), (0.1, at(2.0)?)])?;
    /// assert_eq!(mixture.prune(0.15)?.len(), 2);
    /// # Ok::<(), wayfix_gaussian_core::GaussianError>(())
    /// ```
    ///
    /// # Errors
    /// [`GaussianError::NoWeight`] when none is left.
    pub fn prune(self, least: f64) -> Result<Self, GaussianError> {
        let count = self.len();
        let mut kept = self.into_log_weighted();
        kept.retain(|(log_weight, _)| log_weight.exp() >= least);
        if kept.is_empty() { Err(GaussianError::NoWeight { count }) } else { Self::from_log_weights(kept) }
    }
}

/// A mixture cannot be reduced to nothing.
pub(super) fn check_max_components(most: usize) -> Result<(), GaussianError> {
    if most > 0 { Ok(()) } else { Err(GaussianError::Empty { what: "components to keep" }) }
}
