//! Formats of files: found out, compressed, or named where they are not read.

pub(crate) mod compressed;
pub(crate) mod format;
pub(crate) mod unsupported_format;
