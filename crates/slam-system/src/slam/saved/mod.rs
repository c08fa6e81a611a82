//! A map and all that the robot was doing, in a file: versioned, checksummed, never half written.
//!
//! ```text
//! magic      8 bytes   "WAYFIXSM"
//! version    4 bytes   little endian
//! length     8 bytes   of the payload, little endian
//! checksum   4 bytes   CRC-32 of version, length and payload, little endian: finds every burst of up to 32 bits
//! payload              postcard: the kind of map, then everything else
//! ```

mod envelope;
mod error;
mod map;
mod saver;

pub use error::SavedMapError;
pub use map::SlamState;
pub(crate) use map::check_association;
pub use saver::PeriodicStateSaver;
