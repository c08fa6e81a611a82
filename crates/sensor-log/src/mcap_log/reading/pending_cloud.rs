use foxglove::messages::PointCloud;

use super::super::{topics, writing::encode};
use crate::{LogError, Record, RecordData, Stamp, TrueLandmark, TrueWall};

/// Successive landmarks, or walls, of one stamp, collected into one cloud so that viewers draw them together.
#[derive(Default)]
pub(in crate::mcap_log) struct PendingCloud {
    stamp: Stamp,
    landmarks: Vec<TrueLandmark>,
    walls: Vec<TrueWall>,
}

impl PendingCloud {
    /// Whether a landmark or a wall belongs to the same cloud as the previous ones.
    pub(in crate::mcap_log) fn is_of_same_cloud(&self, record: &Record) -> bool {
        let same_kind = match record.data {
            RecordData::TrueWall(_) => self.landmarks.is_empty(),
            _ => self.walls.is_empty(),
        };
        same_kind && record.stamp == self.stamp
    }

    /// Adds a landmark or a wall; ignores other records.
    pub(in crate::mcap_log) fn push(&mut self, record: &Record) {
        self.stamp = record.stamp;
        match record.data {
            RecordData::TrueLandmark(landmark) => self.landmarks.push(landmark),
            RecordData::TrueWall(wall) => self.walls.push(wall),
            _ => {}
        }
    }

    /// The cloud with its topic and stamp; `None` if it is empty.
    pub(in crate::mcap_log) fn into_cloud(
        self,
    ) -> Result<Option<(&'static str, Stamp, PointCloud)>, LogError> {
        if self.landmarks.is_empty() && self.walls.is_empty() {
            return Ok(None);
        }
        let timestamp = encode::timestamp(self.stamp)?;
        let (topic, cloud) = if self.walls.is_empty() {
            (topics::TRUE_LANDMARKS, encode::landmarks(timestamp, &self.landmarks))
        } else {
            (topics::TRUE_WALLS, encode::walls(timestamp, &self.walls))
        };
        Ok(Some((topic, self.stamp, cloud)))
    }
}
