//! Tests of the public interface of `wayfix-line-extract`, in one program: it is linked once.

mod fit;
mod laser;
mod monte_carlo;
#[cfg(feature = "serde")]
mod serde;
mod simplify;
mod support;
