//! The same work on every hypothesis, in order: the same bits for any number of threads.

#[cfg(feature = "parallel")]
use rayon::prelude::*;

/// What `job` makes of every item.
#[cfg(feature = "parallel")]
pub(in crate::contour) fn map_each<T: Sync, O: Send>(items: &[T], job: impl Fn(&T) -> O + Sync) -> Vec<O> {
    items.par_iter().map(&job).collect()
}

/// What `job` makes of every item.
#[cfg(not(feature = "parallel"))]
pub(in crate::contour) fn map_each<T: Sync, O: Send>(items: &[T], job: impl Fn(&T) -> O + Sync) -> Vec<O> {
    items.iter().map(job).collect()
}
