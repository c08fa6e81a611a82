use indicatif::{ProgressBar, ProgressStyle};

/// A bar on standard error that shows itself only on a terminal.
pub fn bar(length: usize, what: &str) -> ProgressBar {
    let style = ProgressStyle::with_template("{msg:24} [{bar:32}] {percent:>3} % {eta_precise}")
        .unwrap_or_else(|_| ProgressStyle::default_bar());
    ProgressBar::new(length as u64).with_style(style.progress_chars("=> ")).with_message(what.to_owned())
}

/// A counter on standard error for work of unknown length.
pub fn counter(what: &str) -> ProgressBar {
    let style = ProgressStyle::with_template("{msg:24} {pos}, {per_sec}")
        .unwrap_or_else(|_| ProgressStyle::default_spinner());
    ProgressBar::no_length().with_style(style).with_message(what.to_owned())
}
