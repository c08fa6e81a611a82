use nalgebra::DefaultAllocator;
use rand::{Rng, RngExt, distr::Distribution};
use rand_distr::StandardNormal;
use wayfix_estimation_traits::{Manifold, StateAlloc};

use crate::GaussianMixture;

/// A component drawn by weight, then a point drawn from it.
impl<X: Manifold> Distribution<X> for GaussianMixture<X>
where
    DefaultAllocator: StateAlloc<X::Dim>,
    StandardNormal: Distribution<X::Scalar>,
{
    fn sample<R: Rng + ?Sized>(&self, rng: &mut R) -> X {
        let mut left: f64 = rng.random();
        let mut chosen = 0;
        for (index, log_weight) in self.log_weights().iter().enumerate() {
            let weight = log_weight.exp();
            if weight > 0.0 {
                chosen = index; // rounding of the sum must not pick a component of weight zero
                if left < weight {
                    break;
                }
                left -= weight;
            }
        }
        self.components()[chosen].sample(rng)
    }
}
