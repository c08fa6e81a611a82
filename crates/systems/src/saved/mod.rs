//! Atomic file writes.

mod atomic;

pub(crate) use atomic::write_atomically;
