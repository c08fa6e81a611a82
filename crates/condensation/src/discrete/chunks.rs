//! Work on slices in chunks of a fixed size, reduced in order: the same bits for any number of threads.

#[cfg(feature = "parallel")]
use rayon::prelude::*;

/// Elements a chunk: large enough that handing it to a thread does not count, small enough for a second-level cache.
pub(crate) const CHUNK: usize = 1 << 14;

/// Calls `job(start, chunk)` for every chunk of `slice`, and gives what it returned, in order.
#[cfg(feature = "parallel")]
pub(crate) fn map_chunks<O: Send>(
    slice: &mut [f64],
    size: usize,
    job: impl Fn(usize, &mut [f64]) -> O + Sync,
) -> Vec<O> {
    slice.par_chunks_mut(size).enumerate().map(|(i, chunk)| job(i * size, chunk)).collect()
}

/// Calls `job(start, chunk)` for every chunk of `slice`, and gives what it returned, in order.
#[cfg(not(feature = "parallel"))]
pub(crate) fn map_chunks<O: Send>(
    slice: &mut [f64],
    size: usize,
    job: impl Fn(usize, &mut [f64]) -> O + Sync,
) -> Vec<O> {
    slice.chunks_mut(size).enumerate().map(|(i, chunk)| job(i * size, chunk)).collect()
}

/// The same over chunks that are only read.
#[cfg(feature = "parallel")]
pub(crate) fn fold_chunks<O: Send>(slice: &[f64], job: impl Fn(usize, &[f64]) -> O + Sync) -> Vec<O> {
    slice.par_chunks(CHUNK).enumerate().map(|(i, chunk)| job(i * CHUNK, chunk)).collect()
}

/// The same over chunks that are only read.
#[cfg(not(feature = "parallel"))]
pub(crate) fn fold_chunks<O: Send>(slice: &[f64], job: impl Fn(usize, &[f64]) -> O + Sync) -> Vec<O> {
    slice.chunks(CHUNK).enumerate().map(|(i, chunk)| job(i * CHUNK, chunk)).collect()
}
