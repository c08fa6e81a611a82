use rayon::prelude::*;

use super::sequential;

/// As the sequential form, with chunks shared out over the threads of the current pool.
pub(crate) fn map_chunks<X: Send, T: Send>(
    size: usize,
    states: &mut [X],
    numbers: &mut [f64],
    job: impl Fn(usize, &mut [X], &mut [f64]) -> T + Sync,
) -> Vec<T> {
    if states.len() <= size {
        // Waking another thread costs more than it helps.
        return sequential::map_chunks(size, states, numbers, job);
    }
    states
        .par_chunks_mut(size)
        .zip(numbers.par_chunks_mut(size))
        .enumerate()
        .map(|(chunk, (states, numbers))| job(chunk, states, numbers))
        .collect()
}

#[cfg(test)]
mod tests {
    use super::{super::CHUNK, *};

    #[test]
    fn both_forms_do_the_same_jobs_in_the_same_order() {
        let job = |chunk: usize, states: &mut [u64], numbers: &mut [f64]| {
            for (state, number) in states.iter_mut().zip(numbers) {
                *state += chunk as u64;
                *number = (*state as f64).sqrt();
            }
            states.iter().sum::<u64>()
        };
        for n in [0, 1, CHUNK - 1, CHUNK, CHUNK + 1, 10 * CHUNK + 7] {
            let states: Vec<u64> = (0..n as u64).collect();
            let (mut a, mut b) = (states.clone(), states);
            let (mut x, mut y) = (vec![0.0; n], vec![0.0; n]);
            let results = map_chunks(CHUNK, &mut a, &mut x, job);
            assert_eq!(results, sequential::map_chunks(CHUNK, &mut b, &mut y, job));
            assert_eq!((a, x), (b, y));
        }
    }
}
