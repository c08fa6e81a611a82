//! Fixed chunks of particles: the unit of work for a thread, with a random stream of its own.

#[cfg(feature = "parallel")]
mod parallel;
mod sequential;
mod streams;

#[cfg(feature = "parallel")]
pub(crate) use parallel::map_chunks;
#[cfg(not(feature = "parallel"))]
pub(crate) use sequential::map_chunks;
pub use streams::ParticleChunkRng;
pub(crate) use streams::Streams;

/// Particles a chunk. Changing it changes the random numbers every particle gets, but no distribution: small enough that a hundred particles
/// keep several threads busy, large enough that setting up a stream (some 100 ns) does not count.
pub(crate) const CHUNK: usize = 32;
