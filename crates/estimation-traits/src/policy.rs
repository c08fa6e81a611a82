/// A small predicate that says when to act: a type of its own, or a closure.
///
/// `C` is what the decision depends on: an effective sample size, a distance travelled, `()` for none.
///
/// ```
/// use wayfix_estimation_traits::Policy;
/// // every second step, but only while the effective share of particles is below one half
/// let mut step = 0;
/// let mut resample = |share: &f64| {
///     step += 1;
///     step % 2 == 0 && *share < 0.5
/// };
/// let fired: Vec<bool> = [0.4, 0.4, 0.9, 0.9, 0.1, 0.1].iter().map(|share| resample.fires(share)).collect();
/// assert_eq!(fired, [false, true, false, false, false, true]);
/// ```
pub trait Policy<C: ?Sized> {
    /// Whether to act now. Called once a step: counting policies count here.
    fn fires(&mut self, context: &C) -> bool;
}

impl<C: ?Sized, F: FnMut(&C) -> bool> Policy<C> for F {
    fn fires(&mut self, context: &C) -> bool {
        self(context)
    }
}
