use nalgebra::DefaultAllocator;
use wayfix_estimation_traits::{Manifold, MotionModel, SensorModel, StateAlloc, UpdateAlloc};
use wayfix_gaussian_core::Gaussian;

use crate::{Innovation, error::Checked};

/// One way to carry a Gaussian through models: extended, unscented, square-root, information, …
///
/// A form is a value without state; the [`Belief`](Self::Belief) it works on is what it likes to carry (a covariance, its factor, its
/// inverse). [`GaussianFilter`](crate::GaussianFilter) keeps one belief; the switching filters keep many.
///
/// **Laws**, which the crate's tests check for every form here:
/// 1. on linear Gaussian models every form gives the same Gaussian, up to rounding,
/// 2. a belief that comes out is symmetric positive definite; what is not is an error,
/// 3. `update` shows the innovation to `admits` before anything else and returns no belief when that says no.
pub trait Form<X: Manifold>
where
    DefaultAllocator: StateAlloc<X::Dim>,
{
    /// What the form carries from step to step.
    type Belief: Clone;

    /// The belief that says the same as `gaussian`.
    ///
    /// # Errors
    /// When its covariance is not positive definite.
    fn belief_from(&self, gaussian: &Gaussian<X>) -> Checked<Self::Belief>;

    /// The Gaussian that says the same as `belief`.
    fn gaussian(&self, belief: &Self::Belief) -> Gaussian<X>;

    /// The belief after `control`.
    ///
    /// # Errors
    /// When the model gives something unusable.
    fn predict<M>(&self, belief: &Self::Belief, motion: &M, control: &M::Control) -> Checked<Self::Belief>
    where
        M: MotionModel<State = X>;

    /// What `measurement` says, and the belief after it when `admits` lets it in.
    ///
    /// # Errors
    /// When the model or measurement is unusable.
    #[allow(clippy::type_complexity, reason = "a pair of the two things the documentation names")]
    fn update<S>(
        &self,
        belief: &Self::Belief,
        sensor: &S,
        measurement: &S::Measurement,
        admits: impl FnOnce(&Innovation<X, S::Measurement>) -> bool,
    ) -> Checked<(Innovation<X, S::Measurement>, Option<Self::Belief>)>
    where
        S: SensorModel<State = X>,
        DefaultAllocator: UpdateAlloc<X::Dim, <S::Measurement as Manifold>::Dim>;
}
