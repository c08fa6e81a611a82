use std::collections::BTreeMap;

use wayfix_estimation_traits::Pose2;
use wayfix_gaussian_core::GaussianMixture;

use super::{entry::Entry, map_archive::append};
use crate::{AppearanceMap, PanoramaDescriptor, ReferenceId, ReferenceSearch, ReferenceView};

/// Record of what an archive already holds of a map, so that only changes are appended.
///
/// ```
/// use nalgebra::Vector3;
/// use wayfix_appearance_cml::{AppearanceMap, ArchivedDescriptorFormat, MapArchiveAppender, MapArchive, PanoramaDescriptor, PanoramaDescriptorParams};
/// use wayfix_estimation_traits::Pose2;
/// use wayfix_gaussian_core::Gaussian;
/// let params = ArchivedDescriptorFormat { views: PanoramaDescriptorParams::default(), size: (120, 25) };
/// let mut map: AppearanceMap<PanoramaDescriptor> = AppearanceMap::default();
/// let mut bytes = MapArchive::to_bytes(&params, &map, None);
/// let mut journal = MapArchiveAppender::after(&map);
/// let pose = Gaussian::from_sigmas(Pose2::new(1.0, 2.0, 0.0), &Vector3::new(0.1, 0.1, 0.1))?;
/// map.teach(PanoramaDescriptor::from_parts(0.01, 1, vec![3, 20, -5])?, &pose)?;
/// bytes.extend(journal.changes(&map, None));
/// assert_eq!(MapArchive::from_bytes(&bytes)?.len(), 1);
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
#[derive(Clone, Debug)]
pub struct MapArchiveAppender {
    written: BTreeMap<ReferenceId, ReferenceView>,
}

impl MapArchiveAppender {
    /// A journal that continues after the bytes of this map.
    pub fn after<S: ReferenceSearch<PanoramaDescriptor>>(map: &AppearanceMap<PanoramaDescriptor, S>) -> Self {
        Self { written: map.references().clone() }
    }

    /// The bytes to append for what has changed since the last call, and for where the robot is now.
    pub fn changes<S: ReferenceSearch<PanoramaDescriptor>>(
        &mut self,
        map: &AppearanceMap<PanoramaDescriptor, S>,
        state: Option<&GaussianMixture<Pose2<f64>>>,
    ) -> Vec<u8> {
        let mut bytes = Vec::new();
        for id in self.written.keys().filter(|id| map.reference(**id).is_none()) {
            append(&Entry::Forgotten(*id), &mut bytes);
        }
        for (id, reference) in map.references() {
            match self.written.get(id) {
                Some(written) if written == reference => {}
                Some(_) => append(&Entry::Places(*id, reference.clone()), &mut bytes),
                None => {
                    let Some(view) = map.search().get(*id) else { continue };
                    append(&Entry::Reference(*id, view.clone(), reference.clone()), &mut bytes);
                }
            }
        }
        append(&Entry::Scale(map.scale().clone(), map.next_id()), &mut bytes);
        append(&Entry::State(state.cloned()), &mut bytes);
        self.written = map.references().clone();
        bytes
    }
}
