use wayfix_evaluation::plot::Decimated;

/// Estimates that a run keeps for figures and pictures: two hours at 9 Hz. Memory does not grow with a longer log.
pub const MOST_ESTIMATES: usize = 1 << 16;

/// Says when figures are of some estimates only.
pub(crate) fn note_of_sample<T>(sample: &Decimated<T>) -> Option<String> {
    let stride = sample.stride();
    (stride > 1).then(|| {
        format!(
            "The log is long: figures and pictures are of every {stride}th of {} estimates.",
            sample.n_seen()
        )
    })
}
