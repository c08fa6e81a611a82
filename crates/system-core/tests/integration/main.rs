//! Tests of the public interface of `wayfix-system-core`, in one program: it is linked once.

mod drive;
mod known_start;
