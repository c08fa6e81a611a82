use nalgebra::DefaultAllocator;
use wayfix_estimation_traits::{Manifold, MotionModel, SensorModel, StateAlloc, UpdateAlloc};
use wayfix_gaussian_core::Gaussian;

use crate::{Innovation, error::Checked};

/// A method of propagating a Gaussian through models: extended, unscented, square-root, information, …
///
/// A form is a value without state; its [`Belief`](Self::Belief) is the representation of the Gaussian (a covariance, its factor, its inverse).
/// [`GaussianFilter`](crate::GaussianFilter) stores one belief; the switching filters store several.
///
/// **Laws**, which the crate's tests check for every form here:
/// 1. on linear Gaussian models every form gives the same Gaussian, up to rounding,
/// 2. a returned belief is symmetric positive definite; otherwise an error is returned,
/// 3. `update` calls `admits` with the innovation first and returns no belief if it returns `false`.
pub trait KalmanAlgorithm<X: Manifold>
where
    DefaultAllocator: StateAlloc<X::Dim>,
{
    /// The representation of the Gaussian from step to step.
    type Belief: Clone + Into<Gaussian<X>>;

    /// The belief equivalent to `gaussian`.
    ///
    /// # Errors
    /// Returns an error if its covariance is not positive definite.
    fn belief_from(&self, gaussian: &Gaussian<X>) -> Checked<Self::Belief>;

    /// The belief after `control`.
    ///
    /// # Errors
    /// Returns an error if the model output is invalid.
    fn predict<M>(&self, belief: &Self::Belief, motion: &M, control: &M::Control) -> Checked<Self::Belief>
    where
        M: MotionModel<State = X>;

    /// The innovation of `measurement`, and the corrected belief if `admits` accepts it.
    ///
    /// # Errors
    /// Returns an error if the model output or measurement is invalid.
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
