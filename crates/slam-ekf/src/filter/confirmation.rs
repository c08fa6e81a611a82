use nalgebra::DefaultAllocator;

use super::{EkfSlam, state::Slot};
use crate::{Innovation, LandmarkDim, LandmarkId, LandmarkModel, MeasurementDim, RobotDim, SlamAlloc};

/// What a landmark must show before it counts.
///
/// Until then it is tentative: it is in the state, so nothing that was seen is lost, but it does not count as part of the map, it can leave
/// again when it is not seen in time, and it starts anew when a sighting says it is somewhere else. A false detection or a first
/// sighting that was an outlier cannot stay.
#[derive(Clone, Copy, Debug, PartialEq)]
#[cfg_attr(
    feature = "serde",
    derive(serde::Serialize, serde::Deserialize),
    serde(default, deny_unknown_fields)
)]
pub struct Confirmation {
    /// Looks in which it must be seen, the first included; 1 takes every landmark at first sight.
    pub n_sightings: usize,
    /// Looks without it after which a tentative landmark is forgotten; never, when not given. Identities that are read need no such
    /// end, landmarks that association made up do.
    #[cfg_attr(feature = "serde", serde(skip_serializing_if = "Option::is_none"))]
    pub patience: Option<usize>,
    /// NIS above which a sighting contradicts a tentative landmark, which then starts anew. 13.8 is the 0.999 quantile for range and
    /// bearing.
    pub contradiction: f64,
}

impl Default for Confirmation {
    /// Two sightings that agree.
    fn default() -> Self {
        Self { n_sightings: 2, patience: None, contradiction: 13.8155 }
    }
}

impl<M: LandmarkModel> EkfSlam<M>
where
    DefaultAllocator: SlamAlloc<RobotDim<M>, LandmarkDim<M>, MeasurementDim<M>>,
{
    pub(super) fn is_confirmed(&self, slot: &Slot<M::Landmark>) -> bool {
        slot.n_sightings >= self.params.confirmation.n_sightings
    }

    pub(super) fn is_tentative(&self, id: LandmarkId) -> bool {
        self.landmarks.get(&id).is_some_and(|slot| !self.is_confirmed(slot))
    }

    pub(super) fn contradicts_its_start(
        &self,
        id: LandmarkId,
        innovation: &Innovation<M::Measurement>,
    ) -> bool {
        self.is_tentative(id) && innovation.nis > self.params.confirmation.contradiction
    }

    pub(super) fn note_sighting(&mut self, id: LandmarkId) {
        if let Some(slot) = self.landmarks.get_mut(&id) {
            slot.n_sightings += 1;
            slot.last_seen = self.look;
        }
    }

    /// Forgets tentative landmarks that were not seen again in time.
    pub(super) fn forget_unconfirmed(&mut self) {
        let Some(patience) = self.params.confirmation.patience else {
            return;
        };
        let is_overdue = |slot: &Slot<M::Landmark>| self.look - slot.last_seen > patience;
        let overdue: Vec<LandmarkId> = self
            .landmarks
            .iter()
            .filter(|(_, slot)| !self.is_confirmed(slot) && is_overdue(slot))
            .map(|(id, _)| *id)
            .collect();
        for id in overdue {
            self.remove(id);
        }
    }
}
