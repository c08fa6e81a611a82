/// A small predicate that says when to act; policies compose.
///
/// `C` is what the decision looks at: an effective sample size, a distance travelled, `()` for none.
///
/// ```
/// use wayfix_estimation_traits::{Policy, PolicyExt, every_n, when};
/// // every second step, but only while the effective share of particles is below one half
/// let mut resample = every_n(2).and(when(|share: &f64| *share < 0.5));
/// let fired: Vec<bool> = [0.4, 0.4, 0.9, 0.9, 0.1, 0.1].iter().map(|share| resample.fires(share)).collect();
/// assert_eq!(fired, [false, true, false, false, false, true]);
/// ```
pub trait Policy<C: ?Sized> {
    /// Whether to act now. Called once a step: counting policies count here.
    fn fires(&mut self, context: &C) -> bool;
}

/// Composition of policies, for every policy; apart from [`Policy`] so that no context type has to be spelt out.
pub trait PolicyExt: Sized {
    /// Acts when both do. Both are always asked, so counters keep counting.
    fn and<P>(self, other: P) -> And<Self, P> {
        And(self, other)
    }
    /// Acts when either does. Both are always asked, so counters keep counting.
    fn or<P>(self, other: P) -> Or<Self, P> {
        Or(self, other)
    }
    /// Acts when this one does not.
    fn not(self) -> Not<Self> {
        Not(self)
    }
}
impl<P> PolicyExt for P {}

/// See [`PolicyExt::and`].
#[derive(Clone, Copy, Debug)]
pub struct And<A, B>(A, B);
/// See [`PolicyExt::or`].
#[derive(Clone, Copy, Debug)]
pub struct Or<A, B>(A, B);
/// See [`PolicyExt::not`].
#[derive(Clone, Copy, Debug)]
pub struct Not<A>(A);
/// See [`always`].
#[derive(Clone, Copy, Debug)]
pub struct Always;
/// See [`never()`].
#[derive(Clone, Copy, Debug)]
pub struct Never;
/// See [`every_n`].
#[derive(Clone, Copy, Debug)]
pub struct EveryN {
    period: usize,
    count: usize,
}
/// See [`when`].
#[derive(Clone, Copy, Debug)]
pub struct When<F>(F);

/// Acts at every step.
pub fn always() -> Always {
    Always
}
/// Never acts.
pub fn never() -> Never {
    Never
}
/// Acts at every `period`-th step, first at step `period`; 0 and 1 both mean every step.
pub fn every_n(period: usize) -> EveryN {
    EveryN { period: period.max(1), count: 0 }
}
/// Acts when `predicate` holds of the context.
pub fn when<F>(predicate: F) -> When<F> {
    When(predicate)
}

impl<C: ?Sized> Policy<C> for Always {
    fn fires(&mut self, _: &C) -> bool {
        true
    }
}
impl<C: ?Sized> Policy<C> for Never {
    fn fires(&mut self, _: &C) -> bool {
        false
    }
}
impl<C: ?Sized> Policy<C> for EveryN {
    fn fires(&mut self, _: &C) -> bool {
        self.count = (self.count + 1) % self.period;
        self.count == 0
    }
}
impl<C: ?Sized, F: FnMut(&C) -> bool> Policy<C> for When<F> {
    fn fires(&mut self, context: &C) -> bool {
        (self.0)(context)
    }
}
impl<C: ?Sized, A: Policy<C>, B: Policy<C>> Policy<C> for And<A, B> {
    fn fires(&mut self, context: &C) -> bool {
        self.0.fires(context) & self.1.fires(context)
    }
}
impl<C: ?Sized, A: Policy<C>, B: Policy<C>> Policy<C> for Or<A, B> {
    fn fires(&mut self, context: &C) -> bool {
        self.0.fires(context) | self.1.fires(context)
    }
}
impl<C: ?Sized, A: Policy<C>> Policy<C> for Not<A> {
    fn fires(&mut self, context: &C) -> bool {
        !self.0.fires(context)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn counters_keep_counting_inside_compositions() {
        let mut policy = every_n(3).or(every_n(2)).and(always()).and(never().not());
        let fired: Vec<bool> = (1..=6).map(|_| Policy::<()>::fires(&mut policy, &())).collect();
        assert_eq!(fired, [false, true, true, true, false, true]);
    }
}
