//! Tests of the public interface of `wayfix-visual-tracking`, in one program: it is linked once.

mod active_head;
mod colors;
mod common;
mod contour;
mod correlation_tracker;
mod head_tracker;
mod masks;
