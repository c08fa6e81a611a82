use nalgebra::DefaultAllocator;

use super::super::{EkfSlam, state::Slot};
use crate::{Innovation, LandmarkDim, LandmarkId, LandmarkModel, MeasurementDim, RobotDim, SlamAlloc};

/// Conditions for a landmark to be confirmed.
///
/// A new landmark is tentative: it is in the state, so no observation is lost, but it is not part of the map. It is removed if it is not
/// observed in time, and it restarts if an observation contradicts its place. So false detections and outliers at the start do not remain.
#[derive(Clone, Copy, Debug, PartialEq)]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
#[cfg_attr(
    feature = "serde",
    derive(serde::Serialize, serde::Deserialize),
    serde(default, deny_unknown_fields)
)]
pub struct LandmarkConfirmationParams {
    /// Scans in which it must be detected, the first included; 1 confirms every landmark at its first detection.
    pub min_detections: usize,
    /// Number of consecutive misses after which a tentative landmark is removed; never, if not given. Landmarks with an identity that the sensor
    /// reads do not need it; landmarks that data association starts do.
    #[cfg_attr(feature = "serde", serde(skip_serializing_if = "Option::is_none"))]
    pub max_consecutive_misses: Option<usize>,
    /// NIS above which an observation contradicts a tentative landmark, which then restarts. 13.8 is the 0.999 quantile for range and
    /// bearing.
    pub tentative_restart_nis: f64,
    /// Share of the scans with a confirmed landmark in view in which it must be detected, or it leaves the map; 0 keeps all. Tested after more
    /// than `max_consecutive_misses` misses.
    pub min_detection_rate: f64,
}

impl Default for LandmarkConfirmationParams {
    /// Two observations that agree.
    fn default() -> Self {
        Self {
            min_detections: 2,
            max_consecutive_misses: None,
            tentative_restart_nis: 13.8155,
            min_detection_rate: 0.0,
        }
    }
}

impl<M: LandmarkModel> EkfSlam<M>
where
    DefaultAllocator: SlamAlloc<RobotDim<M>, LandmarkDim<M>, MeasurementDim<M>>,
{
    pub(in crate::filter) fn is_confirmed(&self, slot: &Slot<M::Landmark>) -> bool {
        slot.n_detections >= self.params.confirmation.min_detections
    }

    pub(in crate::filter) fn is_tentative(&self, id: LandmarkId) -> bool {
        self.landmarks.get(&id).is_some_and(|slot| !self.is_confirmed(slot))
    }

    pub(in crate::filter) fn exceeds_restart_nis(
        &self,
        id: LandmarkId,
        innovation: &Innovation<M::Measurement>,
    ) -> bool {
        self.is_tentative(id) && innovation.nis > self.params.confirmation.tentative_restart_nis
    }

    pub(in crate::filter) fn count_detection(&mut self, id: LandmarkId) {
        if let Some(slot) = self.landmarks.get_mut(&id) {
            slot.n_detections += 1;
            slot.n_missed_in_a_row = 0;
            slot.last_seen = self.n_updates;
        }
    }

    /// Updates the landmark attributes that are not estimated, from one observation.
    pub(in crate::filter) fn extend(&mut self, id: LandmarkId, measurement: &M::Measurement) {
        let in_state = self.landmarks.get_mut(&id).map(|slot| &mut slot.mean);
        let retired = self.retired.get_mut(&id).map(|retired| &mut retired.mean);
        if let Some(mean) = in_state.or(self.anchors.get_mut(&id)).or(retired) {
            *mean = self.model.extended(&self.robot, mean, measurement);
        }
    }

    /// Removes landmarks that were in view but not detected: tentative ones in time, confirmed ones with too low a detection rate.
    pub(in crate::filter) fn remove_undetected(&mut self) {
        let LandmarkConfirmationParams {
            min_detections,
            max_consecutive_misses: Some(max_consecutive_misses),
            min_detection_rate,
            ..
        } = self.params.confirmation
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
            let is_overdue = if slot.n_detections < min_detections {
                slot.n_missed_in_a_row > max_consecutive_misses
            } else {
                slot.n_missed > max_consecutive_misses && share < min_detection_rate
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
