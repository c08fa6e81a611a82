use nalgebra::DefaultAllocator;

use crate::{Manifold, StateAlloc, TangentMatrix, numerical_jacobian};

/// Where a control takes a state: deterministic, with Jacobian and noise.
///
/// $`x_k = f(x_{k-1}, u_k) ⊞ w_k,\; w_k ∼ N(0, Q(x_{k-1}, u_k))`$
///
/// **Laws** ([`laws::motion`](crate::laws::motion) checks them):
/// 1. [`jacobian`](Self::jacobian) is the derivative of [`propagate`](Self::propagate) in tangent coordinates,
/// 2. [`noise`](Self::noise) is symmetric and positive semidefinite,
/// 3. all three are finite for finite arguments. Where a model is undefined it returns non-finite numbers, which filters
///    turn into a typed error.
pub trait MotionModel
where
    DefaultAllocator: StateAlloc<<Self::State as Manifold>::Dim>,
{
    /// What moves.
    type State: Manifold;
    /// What moves it: an odometry increment, a velocity and a duration, `()` for a free motion.
    type Control: ?Sized;

    /// $`f(x, u)`$, without noise.
    fn propagate(&self, state: &Self::State, control: &Self::Control) -> Self::State;

    /// $`F = ∂ (f(x ⊞ δ, u) ⊟ f(x, u)) / ∂δ`$ at $`δ = 0`$. By default a central difference; give the analytic one where speed counts.
    fn jacobian(&self, state: &Self::State, control: &Self::Control) -> TangentMatrix<Self::State> {
        numerical_jacobian(|x: &Self::State| self.propagate(x, control), state)
    }

    /// $`Q`$ in the tangent space of the propagated state.
    fn noise(&self, state: &Self::State, control: &Self::Control) -> TangentMatrix<Self::State>;
}
