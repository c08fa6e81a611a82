//! Tests of the public interface of `wayfix-color-map`, in one program: it is linked once.

mod bad_input;
#[cfg(feature = "serde")]
mod field_file;
#[cfg(feature = "serde")]
mod inner_spans;
mod oracle;
mod support;
mod views;
