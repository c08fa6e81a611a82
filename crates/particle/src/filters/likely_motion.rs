use nalgebra::DefaultAllocator;
use wayfix_estimation_traits::{Manifold, MotionModel, SampleMotion, StateAlloc};
use wayfix_gaussian_core::GaussianMotion;

/// A motion model with a predicted state, as [`AuxiliaryFilter`](crate::AuxiliaryFilter) needs.
///
/// **Law**: mean, mode or any other likely value of $`p(x_k | x_{k-1}, u_k)`$; the better it stands for the whole distribution, the
/// fewer particles the filter needs. [Pitt & Shephard 1999]
pub trait LikelyMotion: SampleMotion {
    /// Where one control likely leads; apply it to every particle.
    fn likely(&self, control: &Self::Control) -> impl Fn(&Self::State) -> Self::State;
}

/// The motion without its noise.
impl<M: MotionModel> LikelyMotion for GaussianMotion<M>
where
    Self: SampleMotion<State = M::State, Control = M::Control>,
    DefaultAllocator: StateAlloc<<M::State as Manifold>::Dim>,
{
    fn likely(&self, control: &M::Control) -> impl Fn(&M::State) -> M::State {
        move |state| self.0.propagate(state, control)
    }
}
