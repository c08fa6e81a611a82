use std::hint::black_box;

/// Prints the best of 15 batches of `job`, each of `calls` calls.
pub(crate) fn measure<O>(name: &str, program: &str, calls: u32, mut job: impl FnMut() -> O) {
    let mut best = f64::INFINITY;
    for _ in 0..15 {
        #[allow(clippy::disallowed_methods, reason = "a benchmark measures time")]
        let start = std::time::Instant::now();
        for _ in 0..calls {
            black_box(job());
        }
        best = best.min(start.elapsed().as_secs_f64() / f64::from(calls));
    }
    println!("bench\t{name}\t{program}\t{:.1}", best * 1e9);
}
