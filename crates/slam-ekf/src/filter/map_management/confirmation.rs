use nalgebra::DefaultAllocator;

use super::super::{EkfSlam, state::Slot};
use crate::{Innovation, LandmarkDim, LandmarkId, LandmarkModel, MeasurementDim, RobotDim, SlamAlloc};

/// What a landmark must show before it counts.
///
/// Until then it is tentative: it is in the state, so nothing that was seen is lost, but it does not count as part of the map, it can leave
/// again when it is not seen in time, and it starts anew when a sighting says it is somewhere else. A false detection or a first
/// sighting that was an outlier cannot stay.
#[derive(Clone, Copy, Debug, PartialEq)]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
#[cfg_attr(
    feature = "serde",
    derive(serde::Serialize, serde::Deserialize),
    serde(default, deny_unknown_fields)
)]
pub struct ConfirmationParams {
    /// Looks in which it must be seen, the first included; 1 takes every landmark at first sight.
    pub n_detections: usize,
    /// Looks in a row that should have shown a tentative landmark and did not after which it is forgotten; never, when not given.
    /// Identities that are read need no such end, landmarks that association made up do.
    #[cfg_attr(feature = "serde", serde(skip_serializing_if = "Option::is_none"))]
    pub max_missed: Option<usize>,
    /// NIS above which a sighting contradicts a tentative landmark, which then starts anew. 13.8 is the 0.999 quantile for range and
    /// bearing.
    pub restart_nis: f64,
    /// Share of the looks that should show it in which a confirmed landmark must be seen, or it leaves the map; 0 keeps all. Judged when
    /// it was missed more than `max_missed` times.
    pub min_detection_rate: f64,
}

impl Default for ConfirmationParams {
    /// Two sightings that agree.
    fn default() -> Self {
        Self { n_detections: 2, max_missed: None, restart_nis: 13.8155, min_detection_rate: 0.0 }
    }
}

impl<M: LandmarkModel> EkfSlam<M>
where
    DefaultAllocator: SlamAlloc<RobotDim<M>, LandmarkDim<M>, MeasurementDim<M>>,
{
    pub(in crate::filter) fn is_confirmed(&self, slot: &Slot<M::Landmark>) -> bool {
        slot.n_detections >= self.params.confirmation.n_detections
    }

    pub(in crate::filter) fn is_tentative(&self, id: LandmarkId) -> bool {
        self.landmarks.get(&id).is_some_and(|slot| !self.is_confirmed(slot))
    }

    pub(in crate::filter) fn exceeds_restart_nis(
        &self,
        id: LandmarkId,
        innovation: &Innovation<M::Measurement>,
    ) -> bool {
        self.is_tentative(id) && innovation.nis > self.params.confirmation.restart_nis
    }

    pub(in crate::filter) fn count_detection(&mut self, id: LandmarkId) {
        if let Some(slot) = self.landmarks.get_mut(&id) {
            slot.n_detections += 1;
            slot.n_missed_in_a_row = 0;
            slot.last_seen = self.n_updates;
        }
    }

    /// Takes from a look what it tells beyond the estimated coordinates.
    pub(in crate::filter) fn extend(&mut self, id: LandmarkId, measurement: &M::Measurement) {
        if let Some(slot) = self.landmarks.get_mut(&id) {
            slot.mean = self.model.extended(&self.robot, &slot.mean, measurement);
        }
    }

    /// Forgets what should have been seen and was not: tentative landmarks in time, confirmed ones that are seen too seldom.
    pub(in crate::filter) fn remove_undetected(&mut self) {
        let ConfirmationParams { n_detections, max_missed: Some(max_missed), min_detection_rate, .. } =
            self.params.confirmation
        else {
            return;
        };
        let mut forgotten = Vec::new();
        let is_missed = |slot: &Slot<M::Landmark>| {
            slot.last_seen < self.n_updates
                && self.model.expects_detection(&self.model.expected(&self.robot, &self.mean(slot)))
        };
        let missed: Vec<bool> = self.landmarks.values().map(is_missed).collect();
        for ((id, slot), is_missed) in self.landmarks.iter_mut().zip(missed) {
            slot.n_missed_in_a_row += usize::from(is_missed);
            slot.n_missed += usize::from(is_missed);
            let share = slot.n_detections as f64 / (slot.n_detections + slot.n_missed) as f64;
            let is_overdue = if slot.n_detections < n_detections {
                slot.n_missed_in_a_row > max_missed
            } else {
                slot.n_missed > max_missed && share < min_detection_rate
            };
            if is_overdue {
                forgotten.push(*id);
            }
        }
        for id in forgotten {
            self.remove(id);
        }
    }
}
