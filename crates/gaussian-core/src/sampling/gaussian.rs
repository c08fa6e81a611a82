use nalgebra::{Const, DefaultAllocator, OVector};
use rand::{Rng, distr::Distribution};
use rand_distr::StandardNormal;
use wayfix_estimation_traits::{Manifold, StateAlloc, Tangent, TangentMatrix};

use super::semidefinite_factor::semidefinite_factor;
use crate::Gaussian;

/// $`x = μ ⊞ L n`$ with $`L L^T = Σ`$ and $`n ∼ N(0, I)`$.
///
/// One factorization a sample; for many, hold a [`GaussianSampler`].
///
/// ```
/// use nalgebra::{Matrix2, Vector2};
/// use rand::{SeedableRng, distr::Distribution};
/// use wayfix_gaussian_core::Gaussian;
/// let gaussian = Gaussian::new(Vector2::new(1.0, 2.0), Matrix2::identity() * 1e-6)?;
/// let mut rng = rand_chacha::ChaCha8Rng::seed_from_u64(7);
/// assert!((gaussian.sample(&mut rng) - gaussian.mean()).norm() < 1e-2); // ten sigma
/// # Ok::<(), wayfix_gaussian_core::GaussianError>(())
/// ```
impl<X: Manifold> Distribution<X> for Gaussian<X>
where
    DefaultAllocator: StateAlloc<X::Dim>,
    StandardNormal: Distribution<X::Scalar>,
{
    fn sample<R: Rng + ?Sized>(&self, rng: &mut R) -> X {
        self.sampler().sample(rng)
    }
}

/// A Gaussian factored once, for many samples.
#[derive(Clone, Debug)]
pub struct GaussianSampler<X: Manifold>
where
    DefaultAllocator: StateAlloc<X::Dim>,
{
    mean: X,
    factor: TangentMatrix<X>,
}

impl<X: Manifold> Gaussian<X>
where
    DefaultAllocator: StateAlloc<X::Dim>,
{
    /// The same distribution with its covariance factored, for many samples.
    pub fn sampler(&self) -> GaussianSampler<X> {
        GaussianSampler { mean: self.mean().clone(), factor: semidefinite_factor(self.covariance()) }
    }
}

impl<X: Manifold> Distribution<X> for GaussianSampler<X>
where
    DefaultAllocator: StateAlloc<X::Dim>,
    StandardNormal: Distribution<X::Scalar>,
{
    fn sample<R: Rng + ?Sized>(&self, rng: &mut R) -> X {
        self.mean.retract(&sample_tangent::<X, R>(&self.factor, self.mean.dim(), rng))
    }
}

/// $`L n`$ with $`n ∼ N(0, I)`$.
pub(super) fn sample_tangent<X: Manifold, R: Rng + ?Sized>(
    factor: &TangentMatrix<X>,
    dim: X::Dim,
    rng: &mut R,
) -> Tangent<X>
where
    DefaultAllocator: StateAlloc<X::Dim>,
    StandardNormal: Distribution<X::Scalar>,
{
    factor * OVector::from_fn_generic(dim, Const::<1>, |_, _| StandardNormal.sample(rng))
}

#[cfg(test)]
mod tests {
    use super::*;
    use approx::assert_abs_diff_eq;
    use nalgebra::{Matrix2, Vector2};
    use rand::SeedableRng;
    use rand_chacha::ChaCha8Rng;

    const SEED: u64 = 20_261_121;

    #[test]
    fn moments_of_samples_are_those_of_the_gaussian() {
        let covariance = Matrix2::new(2.0, 0.6, 0.6, 0.5);
        let gaussian = Gaussian::new(Vector2::new(3.0, -1.0), covariance).unwrap();
        let mut rng = ChaCha8Rng::seed_from_u64(SEED);
        let n = 20_000;
        let sampler = gaussian.sampler();
        let deviations: Vec<Vector2<f64>> =
            (0..n).map(|_| sampler.sample(&mut rng) - gaussian.mean()).collect();
        let count = f64::from(n);
        let mean = deviations.iter().sum::<Vector2<f64>>() / count;
        let scatter = deviations.iter().map(|d| d * d.transpose()).sum::<Matrix2<f64>>() / count;
        // Standard errors: sqrt(σ²/n) of a mean, sqrt((σ_ii σ_jj + σ_ij²)/n) of a covariance entry; five of them leave 3e-6 of false alarms.
        for i in 0..2 {
            assert!(mean[i].abs() < 5.0 * (covariance[(i, i)] / count).sqrt());
            for j in 0..2 {
                let variance = covariance[(i, i)] * covariance[(j, j)] + covariance[(i, j)].powi(2);
                assert_abs_diff_eq!(
                    scatter[(i, j)],
                    covariance[(i, j)],
                    epsilon = 5.0 * (variance / count).sqrt()
                );
            }
        }
    }

    #[test]
    fn a_broken_promise_gives_finite_samples() {
        let gaussian = Gaussian::from_parts_unchecked(Vector2::zeros(), Matrix2::new(1.0, 2.0, 2.0, 1.0));
        let mut rng = ChaCha8Rng::seed_from_u64(SEED);
        assert!((0..100).all(|_| gaussian.sample(&mut rng).iter().all(|x: &f64| x.is_finite())));
    }
}
