/// One chunk of `size` particles after the other: `job(chunk number, particles, their numbers)`; what the jobs return, in chunk order.
///
/// The reference for the parallel form.
pub(crate) fn map_chunks<X: Send, T: Send>(
    size: usize,
    states: &mut [X],
    numbers: &mut [f64],
    job: impl Fn(usize, &mut [X], &mut [f64]) -> T + Sync,
) -> Vec<T> {
    states
        .chunks_mut(size)
        .zip(numbers.chunks_mut(size))
        .enumerate()
        .map(|(chunk, (states, numbers))| job(chunk, states, numbers))
        .collect()
}
