use crate::AppearanceMapError;

/// Why bytes are not a map that can be used here.
///
/// ```
/// use wayfix_appearance_cml::{MapArchive, MapArchiveError};
/// assert_eq!(MapArchive::from_bytes(b"a picture").err(), Some(MapArchiveError::NotAMap));
/// // The version follows the magic: a map of a later program is not called damaged.
/// let later = MapArchive::from_bytes(b"WAYFIXAM\xff\xff\xff\xff");
/// assert!(matches!(later, Err(MapArchiveError::Version { found: u32::MAX, .. })));
/// ```
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
#[non_exhaustive]
pub enum MapArchiveError {
    /// They do not begin as a map does.
    #[error("not an appearance map: it does not begin with WAYFIXAM")]
    NotAMap,
    /// Another version of the program wrote them.
    #[error("written in version {found} of the format; this program reads version {known}")]
    Version {
        /// The version of the bytes.
        found: u32,
        /// The one that can be read.
        known: u32,
    },
    /// The header is cut short or not what was written.
    #[error("the header is damaged")]
    Header,
    /// An entry is not what was written, and others come after it: not the end of an interrupted journal.
    #[error("damaged: entry {index} at byte {offset} is not what was written")]
    Entry {
        /// Its place, from 0.
        index: usize,
        /// Where it begins.
        offset: usize,
    },
    /// The checksum of an entry is right, but its content is invalid.
    #[error("entry {index}: {what}")]
    Content {
        /// Its place, from 0.
        index: usize,
        /// What is wrong.
        what: &'static str,
    },
    /// The map was learned with other parameters: its views cannot be compared with those of now.
    #[error("learned with {what} = {found}, here it is {expected}")]
    Parameters {
        /// What differs.
        what: &'static str,
        /// As it is here.
        expected: String,
        /// As it is in the map.
        found: String,
    },
    /// The parts do not make a map.
    #[error("not a map: {0}")]
    Map(#[from] AppearanceMapError),
}
