//! The colour localizer on simulated and recorded drives: what disturbs a camera brings no wrong certainty, and a robot that stands does not drift.

mod bad_input;
mod standing;
mod support;
mod unknown_start;
