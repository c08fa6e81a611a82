//! Ctrl-C ends a run with the report of what was done.

use std::{
    ops::ControlFlow,
    process::{ExitCode, exit},
    sync::atomic::{AtomicBool, Ordering},
};

use anyhow::{Context, Result};
use wayfix_evaluation::terminal::print_message;

static IS_REQUESTED: AtomicBool = AtomicBool::new(false);
/// Whether the run has done a part that can be reported.
static HAS_PART: AtomicBool = AtomicBool::new(false);
/// Whether the run has ended before its time.
static HAS_ENDED_EARLY: AtomicBool = AtomicBool::new(false);

/// Exit code of a program that Ctrl-C ended.
const INTERRUPTED: u8 = 130;

/// Listens for Ctrl-C: the first one ends the run, the second one the program. Before the first part is done, as while the log is read, the first one
/// ends the program.
/// # Errors
/// Returns an error if the operating system refuses.
pub(in crate::cli) fn listen() -> Result<()> {
    let on_signal = || {
        let has_part = HAS_PART.load(Ordering::Relaxed);
        if !has_part {
            print_message("Ctrl-C: nothing was done that could be reported");
        }
        if IS_REQUESTED.swap(true, Ordering::Relaxed) || !has_part {
            exit(i32::from(INTERRUPTED));
        }
        print_message("Ctrl-C: the run ends here; once more to quit without a report");
    };
    ctrlc::set_handler(on_signal).context("cannot listen for Ctrl-C")
}

/// Whether the run is to end; asked after each part of it.
pub(in crate::cli) fn is_requested() -> bool {
    HAS_PART.store(true, Ordering::Relaxed);
    let is_requested = IS_REQUESTED.load(Ordering::Relaxed);
    if is_requested {
        HAS_ENDED_EARLY.store(true, Ordering::Relaxed);
    }
    is_requested
}

/// The same as a control flow.
pub(in crate::cli) fn flow() -> ControlFlow<()> {
    if is_requested() { ControlFlow::Break(()) } else { ControlFlow::Continue(()) }
}

/// The warning of a run that ended early.
pub(in crate::cli) fn warning() -> Option<String> {
    HAS_ENDED_EARLY
        .load(Ordering::Relaxed)
        .then(|| "Ctrl-C ended the run early: all figures are of the part of the log before".to_owned())
}

/// The exit code, with that of Ctrl-C where it was pressed.
pub(in crate::cli) fn exit_code(code: ExitCode) -> ExitCode {
    if HAS_ENDED_EARLY.load(Ordering::Relaxed) { ExitCode::from(INTERRUPTED) } else { code }
}
