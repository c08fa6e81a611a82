/// Does every job with a scratch space of its thread's. Jobs write to their own places only, so the result does not depend on the number of threads.
#[cfg(not(feature = "parallel"))]
pub(crate) fn for_each<J, S>(
    jobs: impl Iterator<Item = J>,
    scratch: impl Fn() -> S,
    job: impl Fn(&mut S, J),
) {
    let mut scratch = scratch();
    jobs.for_each(|each| job(&mut scratch, each));
}

/// Does every job with a scratch space of its thread's. Jobs write to their own places only, so the result does not depend on the number of threads.
#[cfg(feature = "parallel")]
pub(crate) fn for_each<J: Send, S>(
    jobs: impl Iterator<Item = J>,
    scratch: impl Fn() -> S + Sync + Send,
    job: impl Fn(&mut S, J) + Sync + Send,
) {
    use rayon::prelude::*;
    let jobs: Vec<J> = jobs.collect();
    jobs.into_par_iter().for_each_init(scratch, job);
}
