//! Tests of the public interface of `wayfix-estimation-traits`, in one program: it is linked once.

mod laws_catch;
mod laws_hold;
