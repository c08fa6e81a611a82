use nalgebra::DefaultAllocator;
use rand::{Rng, distr::Distribution};
use rand_distr::StandardNormal;
use wayfix_estimation_traits::{Manifold, MotionModel, SampleMotion, StateAlloc};

use super::{gaussian::sample_tangent, semidefinite_factor::semidefinite_factor};

/// Any [`MotionModel`] as a sampler: $`f(x, u) ⊞ L n`$ with $`L L^T = Q(x, u)`$. Singular noise is fine.
///
/// ```
/// use nalgebra::{Matrix1, Vector1};
/// use rand::SeedableRng;
/// use wayfix_estimation_traits::{MotionModel, SampleMotion};
/// use wayfix_gaussian_core::GaussianMotionSampler;
/// struct Slide;
/// impl MotionModel for Slide {
///     type State = Vector1<f64>;
///     type Control = f64;
///     fn propagate(&self, state: &Vector1<f64>, control: &f64) -> Vector1<f64> {
///         state.add_scalar(*control)
///     }
///     fn noise(&self, _: &Vector1<f64>, _: &f64) -> Matrix1<f64> {
///         Matrix1::new(1e-4)
///     }
/// }
/// let mut rng = rand_chacha::ChaCha8Rng::seed_from_u64(7);
/// let sampler = GaussianMotionSampler(Slide);
/// let next = sampler.sampler(&2.0)(&Vector1::new(1.0), &mut rng);
/// assert!((next[0] - 3.0).abs() < 0.1); // ten sigma
/// ```
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct GaussianMotionSampler<M>(pub M);

impl<M: MotionModel> SampleMotion for GaussianMotionSampler<M>
where
    DefaultAllocator: StateAlloc<<M::State as Manifold>::Dim>,
    StandardNormal: Distribution<<M::State as Manifold>::Scalar>,
{
    type State = M::State;
    type Control = M::Control;

    fn sampler<R: Rng + ?Sized>(&self, control: &M::Control) -> impl Fn(&M::State, &mut R) -> M::State {
        move |state, rng| {
            let moved = self.0.propagate(state, control);
            let factor = semidefinite_factor(&self.0.noise(state, control));
            moved.retract(&sample_tangent::<M::State, R>(&factor, moved.dim(), rng))
        }
    }
}
