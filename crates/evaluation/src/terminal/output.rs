use std::{
    fmt::Display,
    io::{self, ErrorKind, Write},
};

use anyhow::{Context, Result};

/// Writes to standard output. A closed reader (`| head`) is not an error.
/// # Errors
/// Returns an error if standard output cannot be written to.
pub fn print(text: impl Display) -> Result<()> {
    let mut stdout = io::stdout().lock();
    match write!(stdout, "{text}").and_then(|()| stdout.flush()) {
        Err(error) if error.kind() == ErrorKind::BrokenPipe => Ok(()),
        written => written.context("cannot write to standard output"),
    }
}

/// Prints a message to standard error, which may be closed.
pub fn print_message(text: impl Display) {
    let _ = writeln!(io::stderr().lock(), "{}", text.to_string().trim_end());
}
