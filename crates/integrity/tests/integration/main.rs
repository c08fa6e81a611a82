//! Tests of the public interface of `wayfix-integrity`, in one program: it is linked once.

mod false_alarms_and_delay;
mod relocalization;
