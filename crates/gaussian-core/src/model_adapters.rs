use nalgebra::{ComplexField, DefaultAllocator};
use rand::{Rng, distr::Distribution};
use rand_distr::StandardNormal;
use wayfix_estimation_traits::{
    LikelihoodModel, LogWeight, Manifold, MotionModel, SampleMotion, SensorModel, StateAlloc, UpdateAlloc,
};

use crate::{
    covariance::{check_symmetric, semidefinite_factor},
    density::NormalTerms,
    sample::sample_tangent,
};

/// Any [`MotionModel`] as a sampler: $`f(x, u) ⊞ L n`$ with $`L L^T = Q(x, u)`$. Singular noise is fine.
///
/// ```
/// use nalgebra::{Matrix1, Vector1};
/// use rand::SeedableRng;
/// use wayfix_estimation_traits::{MotionModel, SampleMotion};
/// use wayfix_gaussian_core::GaussianMotion;
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
/// let sampler = GaussianMotion(Slide);
/// let next = sampler.given(&2.0)(&Vector1::new(1.0), &mut rng);
/// assert!((next[0] - 3.0).abs() < 0.1); // ten sigma
/// ```
#[derive(Clone, Copy, Debug)]
pub struct GaussianMotion<M>(pub M);

impl<M: MotionModel> SampleMotion for GaussianMotion<M>
where
    DefaultAllocator: StateAlloc<<M::State as Manifold>::Dim>,
    StandardNormal: Distribution<<M::State as Manifold>::Scalar>,
{
    type State = M::State;
    type Control = M::Control;

    fn given<R: Rng + ?Sized>(&self, control: &M::Control) -> impl Fn(&M::State, &mut R) -> M::State {
        move |state, rng| {
            let moved = self.0.propagate(state, control);
            let factor = semidefinite_factor(&self.0.noise(state, control));
            moved.retract(&sample_tangent::<M::State, R>(&factor, moved.dim(), rng))
        }
    }
}

/// Any [`SensorModel`] as a likelihood: $`\log N(z ⊟ h(x); 0, R(x))`$.
///
/// $`-∞`$ where the sensor sees nothing: a prediction that is not finite or a noise that is not positive definite.
///
/// ```
/// use nalgebra::{Matrix1, Vector1, Vector2};
/// use wayfix_estimation_traits::{LikelihoodModel, SensorModel};
/// use wayfix_gaussian_core::GaussianLikelihood;
/// struct Range;
/// impl SensorModel for Range {
///     type State = Vector2<f64>;
///     type Measurement = Vector1<f64>;
///     fn expected(&self, state: &Vector2<f64>) -> Vector1<f64> {
///         Vector1::new(state.norm())
///     }
///     fn noise(&self, _: &Vector2<f64>) -> Matrix1<f64> {
///         Matrix1::new(0.01)
///     }
/// }
/// let likelihood = GaussianLikelihood(Range);
/// let measured = Vector1::new(5.0);
/// let log_weight = likelihood.given(&measured);
/// assert!(log_weight(&Vector2::new(3.0, 4.0)) > log_weight(&Vector2::new(3.0, 4.1)));
/// assert_eq!(log_weight(&Vector2::new(f64::NAN, 0.0)), f64::NEG_INFINITY);
/// ```
#[derive(Clone, Copy, Debug)]
pub struct GaussianLikelihood<S>(pub S);

impl<S: SensorModel> LikelihoodModel for GaussianLikelihood<S>
where
    DefaultAllocator: UpdateAlloc<<S::State as Manifold>::Dim, <S::Measurement as Manifold>::Dim>,
{
    type State = S::State;
    type Measurement = S::Measurement;

    fn given(&self, measurement: &S::Measurement) -> impl Fn(&S::State) -> LogWeight {
        move |state| {
            let noise = self.0.noise(state);
            let innovation = self.0.expected(state).local(measurement);
            let usable = innovation.iter().all(ComplexField::is_finite)
                && noise.nrows() == innovation.nrows()
                && check_symmetric("sensor noise", &noise).is_ok();
            if !usable {
                return LogWeight::NEG_INFINITY;
            }
            NormalTerms::new("sensor noise", &innovation, &noise)
                .map_or(LogWeight::NEG_INFINITY, |terms| terms.log_density())
        }
    }
}
