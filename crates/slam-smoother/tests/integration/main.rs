//! Tests of the public interface of `wayfix-slam-smoother`, in one program: it is linked once.

mod circle;
mod pairing;
mod plaza_data;
mod points;
mod range_only;
