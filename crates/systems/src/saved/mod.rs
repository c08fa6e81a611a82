//! Files that are never half written.

mod atomic;

pub(crate) use atomic::write_atomically;
