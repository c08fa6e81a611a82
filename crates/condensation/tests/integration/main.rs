//! Tests of the public interface of `wayfix-condensation`, in one program: it is linked once.

mod common;
mod discrete;
mod features;
mod laws;
mod learning;
mod navigation;
