//! The same work on every hypothesis, in order: the same bits for any number of threads.

#[cfg(feature = "parallel")]
use rayon::prelude::*;

/// Maps every item with `job`.
#[cfg(feature = "parallel")]
pub(in crate::contour) fn map_each<T: Sync, O: Send>(items: &[T], job: impl Fn(&T) -> O + Sync) -> Vec<O> {
    items.par_iter().map(&job).collect()
}

/// Maps every item with `job`.
#[cfg(not(feature = "parallel"))]
pub(in crate::contour) fn map_each<T: Sync, O: Send>(items: &[T], job: impl Fn(&T) -> O + Sync) -> Vec<O> {
    items.iter().map(job).collect()
}
