use nalgebra::DefaultAllocator;

use crate::{Jacobian, Manifold, TangentMatrix, UpdateAlloc, numerical_jacobian};

/// Logarithm of a weight or likelihood, in nats.
pub type LogWeight = f64;

/// What a sensor should read in a state, with Jacobian and noise.
///
/// $`z = h(x) ⊞ v,\; v ∼ N(0, R(x))`$. Measurement spaces are manifolds too, so bearings wrap by construction.
///
/// **Laws** ([`laws::sensor`](crate::laws::sensor) checks them):
/// 1. [`jacobian`](Self::jacobian) is the derivative of [`expected`](Self::expected) in tangent coordinates,
/// 2. [`noise`](Self::noise) is symmetric and positive definite,
/// 3. all three are finite wherever the sensor sees; elsewhere (a bearing to where the robot stands) they are not, and filters
///    answer with a typed error.
pub trait SensorModel
where
    DefaultAllocator: UpdateAlloc<<Self::State as Manifold>::Dim, <Self::Measurement as Manifold>::Dim>,
{
    /// What is estimated.
    type State: Manifold;
    /// What is measured.
    type Measurement: Manifold<Scalar = <Self::State as Manifold>::Scalar>;

    /// $`h(x)`$: the noise-free measurement.
    fn expected(&self, state: &Self::State) -> Self::Measurement;

    /// $`H = ∂ (h(x ⊞ δ) ⊟ h(x)) / ∂δ`$ at $`δ = 0`$. By default a central difference; give the analytic one where speed counts.
    fn jacobian(&self, state: &Self::State) -> Jacobian<Self::Measurement, Self::State> {
        numerical_jacobian(|x: &Self::State| self.expected(x), state)
    }

    /// $`R`$ in the tangent space of the expected measurement.
    fn noise(&self, state: &Self::State) -> TangentMatrix<Self::Measurement>;
}

/// A measurement as a curried log-likelihood: everything that depends only on the measurement is computed once.
///
/// **Law**: the closure gives $`\log p(z | x)`$ in nats up to a constant that does not depend on $`x`$; never NaN for a finite state,
/// $`-∞`$ where the measurement is impossible.
pub trait LikelihoodModel {
    /// What is weighed.
    type State;
    /// What was measured.
    type Measurement: ?Sized;

    /// The log-likelihood for one measurement; apply it to every particle.
    fn log_likelihood(&self, measurement: &Self::Measurement) -> impl Fn(&Self::State) -> LogWeight;
}
