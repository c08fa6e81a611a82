use nalgebra::DefaultAllocator;
use wayfix_estimation_traits::{Manifold, StateAlloc};

use super::{GaussianMixture, prune::check_max_components, runnalls::merge_pair};
use crate::{GaussianError, IterationError};

impl<X: Manifold> GaussianMixture<X>
where
    DefaultAllocator: StateAlloc<X::Dim>,
{
    /// Merges the lightest component into its nearest neighbour until at most `most` are left.
    ///
    /// Nearest by the squared Mahalanobis distance of the lightest mean in the neighbour's covariance. Cheaper than
    /// [`reduce_runnalls`](Self::reduce_runnalls) and coarser: what is light need not be redundant. [West 1993]
    ///
    /// ```
    /// use nalgebra::Vector1;
    /// use wayfix_gaussian_core::{Gaussian, GaussianMixture};
    /// let at = |x: f64| Gaussian::from_sigmas(Vector1::new(x), &Vector1::new(1.0));
    /// let mixture = GaussianMixture::from_weights(vec![(0.5, at(0.0)?), (0.4, at(9.0)?), (0.1, at(8.0)?)])?;
    /// let reduced = mixture.reduce_west(2)?;
    /// assert!((reduced.components()[1].mean()[0] - 8.8).abs() < 1e-12);
    /// # Ok::<(), Box<dyn std::error::Error>>(())
    /// ```
    ///
    /// # Errors
    /// Returns an error if `most` is 0, a covariance (unchecked) is not positive definite or a merge finds no mean.
    pub fn reduce_west(self, most: usize) -> Result<Self, IterationError<X>> {
        check_max_components(most)?;
        let mut weighted = self.into_log_weighted();
        while weighted.len() > most {
            let lightest =
                (0..weighted.len()).min_by(|&i, &j| weighted[i].0.total_cmp(&weighted[j].0)).unwrap_or(0);
            let (log_weight, light) = weighted.remove(lightest);
            let distances: Result<Vec<f64>, GaussianError> =
                weighted.iter().map(|(_, other)| other.mahalanobis_squared(light.mean())).collect();
            let distances = distances?;
            let nearest =
                (0..distances.len()).min_by(|&i, &j| distances[i].total_cmp(&distances[j])).unwrap_or(0);
            weighted[nearest] =
                merge_pair((weighted[nearest].0, &weighted[nearest].1), (log_weight, &light))?;
        }
        Ok(Self::from_log_weights(weighted)?)
    }
}
