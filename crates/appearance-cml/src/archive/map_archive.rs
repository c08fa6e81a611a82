use std::collections::BTreeMap;

use wayfix_estimation_traits::Pose2;
use wayfix_gaussian_core::GaussianMixture;

use super::{
    ArchivedDescriptorFormat, MapArchiveError,
    bytes::{Reader, Writer},
    entry::Entry,
};
use crate::{
    AppearanceMap, PanoramaDescriptor, ReferenceId, ReferenceSearch, ReferenceView, ViewDifferenceModel,
};

const MAGIC: [u8; 8] = *b"WAYFIXAM";
/// Counts up with every change of what the bytes mean.
const VERSION: u32 = 3;

/// A map of panoramas, where the robot is in it, and what views were described with.
///
/// ```
/// use wayfix_appearance_cml::{AppearanceMap, MapArchiveCompleteness, ArchivedDescriptorFormat, LinearSearch, MapArchive, PanoramaDescriptor, PanoramaDescriptorParams};
/// let params = ArchivedDescriptorFormat { views: PanoramaDescriptorParams::default(), size: (120, 25) };
/// let map: AppearanceMap<PanoramaDescriptor> = AppearanceMap::default();
/// let bytes = MapArchive::to_bytes(&params, &map, None);
/// let archive = MapArchive::from_bytes(&bytes)?;
/// assert_eq!(archive.end(), MapArchiveCompleteness::Whole);
/// let (map, state): (AppearanceMap<PanoramaDescriptor, LinearSearch<_>>, _) = archive.into_map(&params)?;
/// assert!(map.is_empty() && state.is_none());
/// # Ok::<(), wayfix_appearance_cml::MapArchiveError>(())
/// ```
#[derive(Clone, Debug)]
pub struct MapArchive {
    params: ArchivedDescriptorFormat,
    references: BTreeMap<ReferenceId, (PanoramaDescriptor, ReferenceView)>,
    scale: ViewDifferenceModel,
    next: u32,
    state: Option<GaussianMixture<Pose2<f64>>>,
    end: MapArchiveCompleteness,
}

/// A map, and where the robot may be in it; `None` for anywhere.
pub type MapAndState<S> = (AppearanceMap<PanoramaDescriptor, S>, Option<GaussianMixture<Pose2<f64>>>);

/// How the bytes of a map end.
///
/// ```
/// # use wayfix_appearance_cml::{AppearanceMap, ArchivedDescriptorFormat, MapArchive, MapArchiveCompleteness};
/// # use wayfix_appearance_cml::{PanoramaDescriptor, PanoramaDescriptorParams};
/// # let params = ArchivedDescriptorFormat { views: PanoramaDescriptorParams::default(), size: (120, 25) };
/// # let map: AppearanceMap<PanoramaDescriptor> = AppearanceMap::default();
/// let bytes = MapArchive::to_bytes(&params, &map, None);
/// let cut = MapArchive::from_bytes(&bytes[..bytes.len() - 1])?; // a power failure
/// // The last entry, the state of an unknown pose, has 13 bytes; what precedes it is whole.
/// assert_eq!(cut.end(), MapArchiveCompleteness::Interrupted { whole_bytes: bytes.len() - 13 });
/// assert_eq!(MapArchive::from_bytes(&bytes[..bytes.len() - 13])?.end(), MapArchiveCompleteness::Whole);
/// # Ok::<(), wayfix_appearance_cml::MapArchiveError>(())
/// ```
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum MapArchiveCompleteness {
    /// After a whole entry.
    Whole,
    /// In the middle of one, which is left out: writing it was interrupted.
    Interrupted {
        /// Where the whole ones end: a journal continues from here.
        whole_bytes: usize,
    },
}

impl MapArchive {
    /// The bytes of a map, and of where the robot may be.
    pub fn to_bytes<S: ReferenceSearch<PanoramaDescriptor>>(
        params: &ArchivedDescriptorFormat,
        map: &AppearanceMap<PanoramaDescriptor, S>,
        state: Option<&GaussianMixture<Pose2<f64>>>,
    ) -> Vec<u8> {
        let mut bytes = header(params);
        for (id, reference) in map.references() {
            if let Some(view) = map.search().get(*id) {
                append(&Entry::Reference(*id, view.clone(), reference.clone()), &mut bytes);
            }
        }
        append(&Entry::Scale(map.scale().clone(), map.next_id()), &mut bytes);
        append(&Entry::State(state.cloned()), &mut bytes);
        bytes
    }

    /// The map in bytes.
    ///
    /// # Errors
    /// Returns an error if the bytes are not a map, of another version, damaged, or if an entry is invalid ([`MapArchiveError::Content`]).
    /// A last entry that is cut short is no error: [`end`](Self::end) reports it.
    pub fn from_bytes(bytes: &[u8]) -> Result<Self, MapArchiveError> {
        let (params, mut rest) = open(bytes)?;
        let mut archive = Self {
            params,
            references: BTreeMap::new(),
            scale: ViewDifferenceModel::default(),
            next: 0,
            state: None,
            end: MapArchiveCompleteness::Whole,
        };
        let mut index = 0;
        while !rest.is_empty() {
            let offset = bytes.len() - rest.len();
            match next_entry(rest) {
                Next::Entry(entry, after) => {
                    let entry =
                        Entry::from_bytes(entry).map_err(|what| MapArchiveError::Content { index, what })?;
                    archive.take(entry).map_err(|what| MapArchiveError::Content { index, what })?;
                    rest = after;
                }
                Next::CutShort => {
                    archive.end = MapArchiveCompleteness::Interrupted { whole_bytes: offset };
                    break;
                }
                Next::Damaged => return Err(MapArchiveError::Entry { index, offset }),
            }
            index += 1;
        }
        Ok(archive)
    }

    /// What its views were described with.
    pub fn params(&self) -> &ArchivedDescriptorFormat {
        &self.params
    }

    /// How the bytes ended.
    pub fn end(&self) -> MapArchiveCompleteness {
        self.end
    }

    /// How many references.
    pub fn len(&self) -> usize {
        self.references.len()
    }

    /// Whether nothing was learned.
    pub fn is_empty(&self) -> bool {
        self.references.is_empty()
    }

    /// The map and the state, where views are described as `params` say.
    ///
    /// # Errors
    /// When the map was learned with other parameters, or its parts make no map.
    pub fn into_map<S: ReferenceSearch<PanoramaDescriptor> + Default>(
        self,
        params: &ArchivedDescriptorFormat,
    ) -> Result<MapAndState<S>, MapArchiveError> {
        params.check(&self.params)?;
        let mut search = S::default();
        let mut references = BTreeMap::new();
        for (id, (view, reference)) in self.references {
            search.insert(id, view)?;
            references.insert(id, reference);
        }
        Ok((AppearanceMap::from_parts(search, references, self.scale, self.next)?, self.state))
    }

    fn take(&mut self, entry: Entry) -> Result<(), &'static str> {
        match entry {
            Entry::Reference(id, view, reference) => {
                self.references.insert(id, (view, reference));
                self.next = self.next.max(id.0.saturating_add(1));
            }
            Entry::Places(id, places) => {
                let reference =
                    self.references.get_mut(&id).ok_or("places of a reference that is not there")?;
                reference.1 = places;
            }
            Entry::Forgotten(id) => {
                self.references.remove(&id).ok_or("the end of a reference that is not there")?;
            }
            Entry::Scale(scale, next) => (self.scale, self.next) = (scale, next.max(self.next)),
            Entry::State(state) => self.state = state,
        }
        Ok(())
    }
}

/// Adds an entry to the bytes of a map, or to a journal.
pub(super) fn append(entry: &Entry, bytes: &mut Vec<u8>) {
    let content = entry.to_bytes();
    let mut writer = Writer(std::mem::take(bytes));
    writer.u32(content.len() as u32);
    writer.u32(checksum(&content));
    writer.0.extend(content);
    *bytes = writer.0;
}

fn header(params: &ArchivedDescriptorFormat) -> Vec<u8> {
    let mut content = Writer::default();
    params.write(&mut content);
    let mut writer = Writer(MAGIC.to_vec());
    writer.u32(VERSION);
    writer.u32(content.0.len() as u32);
    writer.0.extend(content.0);
    let sum = checksum(&writer.0);
    writer.u32(sum);
    writer.0
}

/// The parameters, and the bytes after the header.
fn open(bytes: &[u8]) -> Result<(ArchivedDescriptorFormat, &[u8]), MapArchiveError> {
    let rest = bytes.strip_prefix(&MAGIC).ok_or(MapArchiveError::NotAMap)?;
    let mut reader = Reader(rest);
    let found = reader.u32().ok_or(MapArchiveError::Header)?;
    if found != VERSION {
        return Err(MapArchiveError::Version { found, known: VERSION });
    }
    let n = reader.u32().ok_or(MapArchiveError::Header)? as usize;
    let content = reader.take(n).ok_or(MapArchiveError::Header)?;
    let summed = bytes.len() - reader.0.len();
    let sum = reader.u32().ok_or(MapArchiveError::Header)?;
    if sum != checksum(&bytes[..summed]) {
        return Err(MapArchiveError::Header);
    }
    let params = ArchivedDescriptorFormat::read(content).ok_or(MapArchiveError::Header)?;
    Ok((params, reader.0))
}

enum Next<'a> {
    Entry(&'a [u8], &'a [u8]),
    CutShort,
    Damaged,
}

fn next_entry(bytes: &[u8]) -> Next<'_> {
    // A file system may have made the file longer before it wrote what belongs there.
    if bytes.iter().all(|byte| *byte == 0) {
        return Next::CutShort;
    }
    let mut reader = Reader(bytes);
    let (Some(n), Some(sum)) = (reader.u32(), reader.u32()) else { return Next::CutShort };
    match reader.take(n as usize) {
        Some(content) if checksum(content) == sum => Next::Entry(content, reader.0),
        Some(_) => Next::Damaged,
        // A flipped bit in the length has the same effect; then whole entries follow within that length.
        None if has_entry_after(bytes) => Next::Damaged,
        None => Next::CutShort,
    }
}

/// No entry is longer than this, and none within that length begins later.
const LONGEST_SWALLOWED: usize = 1 << 16;

/// Whether a whole entry begins anywhere behind the beginning.
fn has_entry_after(bytes: &[u8]) -> bool {
    (1..bytes.len().min(LONGEST_SWALLOWED)).any(|from| {
        let mut reader = Reader(&bytes[from..]);
        let (Some(n), Some(sum)) = (reader.u32(), reader.u32()) else { return false };
        // The smallest entries are an end and a state of nowhere, five bytes.
        let plausible = (5..LONGEST_SWALLOWED).contains(&(n as usize));
        plausible && reader.take(n as usize).is_some_and(|content| checksum(content) == sum)
    })
}

fn checksum(bytes: &[u8]) -> u32 {
    crc32fast::hash(bytes)
}
