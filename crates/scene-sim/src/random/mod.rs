//! Randomness that is the same on every machine: separate streams, and deviates made of exact arithmetic and `libm`.

pub mod deviate;
mod gauss_markov;
mod streams;
mod tail;

pub use gauss_markov::GaussMarkov;
pub use streams::{Source, Streams};
pub use tail::Tail;
