use nalgebra::DefaultAllocator;
use wayfix_estimation_traits::{Manifold, StateAlloc, TangentMatrix};
use wayfix_gaussian_core::{GaussianError, weighted_moments};

use super::ParticleSet;
use crate::ParticleError;

/// Mean and covariance of particles. The covariance is singular when there are fewer particles than dimensions.
#[derive(Clone, Debug, PartialEq)]
pub struct ParticleMoments<Y: Manifold>
where
    DefaultAllocator: StateAlloc<Y::Dim>,
{
    /// Where the weighted deviations cancel.
    pub mean: Y,
    /// In the tangent space at the mean.
    pub covariance: TangentMatrix<Y>,
}

impl<X> ParticleSet<X> {
    /// $`E[f] ≈ \sum_i w_i f(x_i)`$; of an indicator, the probability that it is 1.
    ///
    /// ```
    /// let heights = wayfix_particle::ParticleSet::new(vec![1.0, 2.0, 6.0, 7.0])?;
    /// assert_eq!(heights.expectation(|x| *x)?, 4.0);
    /// assert_eq!(heights.expectation(|x| f64::from(*x > 1.5))?, 0.75); // the probability to be above 1.5
    /// # Ok::<(), wayfix_particle::ParticleError>(())
    /// ```
    ///
    /// # Errors
    /// [`ParticleError::NoWeight`] when every particle is impossible.
    pub fn expectation(&self, function: impl Fn(&X) -> f64) -> Result<f64, ParticleError> {
        let weights = self.weights()?;
        Ok(weights.as_slice().iter().zip(&self.states).map(|(weight, state)| weight * function(state)).sum())
    }

    /// Weighted mean and covariance of what `part` takes from each particle: the whole state, or its pose.
    ///
    /// ```
    /// use wayfix_estimation_traits::Angle;
    /// use wayfix_particle::ParticleSet;
    /// let headings = ParticleSet::new(vec![Angle::new(3.1_f64), Angle::new(-3.1)])?;
    /// let moments = headings.moments(|heading| *heading)?;
    /// assert!((moments.mean.radians().abs() - std::f64::consts::PI).abs() < 1e-12); // not 0: angles wrap
    /// assert!((moments.covariance[(0, 0)].sqrt() - (std::f64::consts::PI - 3.1)).abs() < 1e-12);
    /// # Ok::<(), wayfix_particle::ParticleError>(())
    /// ```
    ///
    /// # Errors
    /// [`ParticleError::NoWeight`] when every particle is impossible; [`ParticleError::Moments`] when the particles have no mean or one of
    /// them is not finite.
    pub fn moments<Y: Manifold>(&self, part: impl Fn(&X) -> Y) -> Result<ParticleMoments<Y>, ParticleError>
    where
        DefaultAllocator: StateAlloc<Y::Dim>,
    {
        let weights = self.weights()?;
        let points: Vec<Y> = self.states.iter().map(part).collect();
        let (mean, covariance) =
            weighted_moments(&points, weights.as_slice()).map_err(GaussianError::from)?;
        Ok(ParticleMoments { mean, covariance })
    }
}
