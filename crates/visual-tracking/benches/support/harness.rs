use std::hint::black_box;

/// Prints the best of `calls` calls: other load only ever adds.
pub(crate) fn measure<O>(name: &str, calls: usize, mut job: impl FnMut() -> O) {
    let mut best = f64::INFINITY;
    for _ in 0..calls {
        #[allow(clippy::disallowed_methods, reason = "a benchmark measures time")]
        let start = std::time::Instant::now();
        black_box(job());
        best = best.min(start.elapsed().as_secs_f64());
    }
    println!("bench\t{name}\twayfix\t{:.0}", best * 1e9);
}
