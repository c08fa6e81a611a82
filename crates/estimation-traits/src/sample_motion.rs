use rand::Rng;

/// A motion as a curried sampler: everything that depends only on the control is computed once.
///
/// **Law**: for a fixed control the samples are distributed as $`p(x_k | x_{k-1}, u_k)`$, and the same generator state gives the same sample.
pub trait SampleMotion {
    /// What moves.
    type State;
    /// What moves it.
    type Control: ?Sized;

    /// The sampler for one control; apply it to every particle.
    fn sampler<R: Rng + ?Sized>(
        &self,
        control: &Self::Control,
    ) -> impl Fn(&Self::State, &mut R) -> Self::State;
}
