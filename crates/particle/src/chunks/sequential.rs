use super::CHUNK;

/// One chunk after the other: `job(chunk number, particles, their numbers)`; what the jobs return, in chunk order.
///
/// The reference for the parallel form.
pub(crate) fn map_chunks<X: Send, T: Send>(
    states: &mut [X],
    numbers: &mut [f64],
    job: impl Fn(usize, &mut [X], &mut [f64]) -> T + Sync,
) -> Vec<T> {
    states
        .chunks_mut(CHUNK)
        .zip(numbers.chunks_mut(CHUNK))
        .enumerate()
        .map(|(chunk, (states, numbers))| job(chunk, states, numbers))
        .collect()
}
