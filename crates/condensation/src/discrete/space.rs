/// A finite set of states and what can be done in them.
///
/// States are numbered from 0. **Laws**: [`step`](Self::step) stays inside, for every state and action; a move that would leave the
/// space leads to where a wall would stop it.
///
/// ```
/// use wayfix_condensation::{DiscreteStateSpace, TransitionModel};
/// struct Ring(usize);
/// impl DiscreteStateSpace for Ring {
///     type Action = bool;
///     fn n_states(&self) -> usize { self.0 }
///     fn actions(&self) -> &[bool] { &[false, true] } // stand still, go on
///     fn step(&self, state: usize, go: bool) -> usize { (state + usize::from(go)) % self.0 }
/// }
/// assert_eq!(Ring(5).step(4, true), 0);
/// ```
pub trait DiscreteStateSpace {
    /// What the robot may do.
    type Action: Copy;

    /// How many states there are.
    fn n_states(&self) -> usize;

    /// Everything that may be done, in the order in which equal choices are preferred.
    fn actions(&self) -> &[Self::Action];

    /// Where an action leads if nothing goes wrong. `state` is below [`n_states`](Self::n_states).
    fn step(&self, state: usize, action: Self::Action) -> usize;
}
