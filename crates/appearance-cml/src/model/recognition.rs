/// Which references of the map speak for a place.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Default)]
pub enum Recognition {
    /// Those within $`E^{max}`$, weighted by $`S`$: one view is almost enough. [Gross et al. 2005, Sec. 2.2]
    #[default]
    Sure,
    /// All that are nearer than those of other places usually are, weighted by [`ViewScale::recognition`](super::ViewScale::recognition): it
    /// takes a sequence of views, and finds a robot beside the lane that was taught.
    Weak,
}
