//! Tests of the public interface of `wayfix-appearance-cml`, in one program: it is linked once.

mod archive;
mod bad_input;
mod common;
mod laps;
mod learning;
mod previous_hypothesis;
mod rearranged;
mod relocalization;
mod search;
mod views;
