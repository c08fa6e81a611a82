//! Ctrl-C ends a run with the report of what was done.

use std::{
    process::{ExitCode, exit},
    sync::atomic::{AtomicBool, Ordering},
};

use anyhow::{Context, Result};
use wayfix_evaluation::terminal::print_message;

static IS_REQUESTED: AtomicBool = AtomicBool::new(false);

/// Exit code of a program that Ctrl-C ended.
const INTERRUPTED: u8 = 130;

/// Listens for Ctrl-C: the first one ends the run, the second one the program.
/// # Errors
/// Returns an error if the operating system refuses.
pub(in crate::cli) fn listen() -> Result<()> {
    let on_signal = || {
        if IS_REQUESTED.swap(true, Ordering::Relaxed) {
            exit(i32::from(INTERRUPTED));
        }
        print_message("Ctrl-C: the run ends here; once more to quit without a report");
    };
    ctrlc::set_handler(on_signal).context("cannot listen for Ctrl-C")
}

/// Whether the run is to end.
pub(in crate::cli) fn is_requested() -> bool {
    IS_REQUESTED.load(Ordering::Relaxed)
}

/// The warning of a run that ended early.
pub(in crate::cli) fn warning() -> Option<String> {
    is_requested()
        .then(|| "Ctrl-C ended the run early: all figures are of the part of the log before".to_owned())
}

/// The exit code, with that of Ctrl-C where it was pressed.
pub(in crate::cli) fn exit_code(code: ExitCode) -> ExitCode {
    if is_requested() { ExitCode::from(INTERRUPTED) } else { code }
}
