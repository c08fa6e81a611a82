//! A learned map, and where the robot is in it, as bytes.
//!
//! ```text
//! header     magic "WAYFIXAM", version, length of the parameters, parameters, CRC-32 of all before
//! entries    each: length, CRC-32 of its bytes, bytes
//! ```
//! All numbers are little endian. Entries say what there is or has become: a reference, its places, its end, the scale of views, the state. A map is
//! a header and entries; later ones may be appended as a journal, so that a robot does not write the whole map again for every view that it
//! learns. A power failure cuts the entry that is being appended; all entries before it are whole.

mod bytes;
mod entry;
mod error;
mod journal;
mod map_archive;
mod params;

pub use error::MapArchiveError;
pub use journal::MapArchiveAppender;
pub use map_archive::{MapAndState, MapArchive, MapArchiveCompleteness};
pub use params::ArchivedDescriptorFormat;
