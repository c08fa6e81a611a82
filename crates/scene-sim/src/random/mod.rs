//! Randomness that is the same on every machine: separate streams, and deviates made of exact arithmetic and `libm`.

pub mod deviate;
mod gauss_markov;
mod noise_shape;
mod streams;

pub use gauss_markov::GaussMarkovProcess;
pub use noise_shape::NoiseShape;
pub use streams::{RandomStreamPurpose, RandomStreams};
