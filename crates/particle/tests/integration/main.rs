//! Tests of the public interface of `wayfix-particle`, in one program: it is linked once.

mod common;
mod hostile;
mod kld;
mod linear_gaussian;
mod looking_ahead;
mod rao_blackwell;
mod resampling;
mod threads;
