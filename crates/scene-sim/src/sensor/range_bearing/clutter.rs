use wayfix_sensor_log::{Detection, DetectionTarget};

use super::RangeBearingParams;
use crate::random::{RandomStreamPurpose, RandomStreams, deviate};
use crate::{SimulationError, check};

/// False detections: a Poisson number per scan, uniform in range and bearing over the field of view.
#[derive(Clone, Copy, Debug, PartialEq, Default)]
pub struct Clutter {
    /// Mean number per scan, at most 100. Default 0.
    pub mean: f64,
    /// Their identity. Default none.
    pub label: ClutterIdentity,
}

/// Identity of a false detection.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Default)]
pub enum ClutterIdentity {
    /// No identity.
    #[default]
    Unlabelled,
    /// One of the world's landmarks, anyone.
    AnyLandmark,
    /// A code that no table lists.
    UnknownCode(u32),
}

impl Clutter {
    pub(super) fn validate(&self) -> Result<(), SimulationError> {
        check::not_negative("mean number of false detections", self.mean)?;
        check::at_most("mean number of false detections", self.mean, 100.0, "at most 100")
    }

    /// The false detections of one scan.
    pub(super) fn draw(
        &self,
        params: &RangeBearingParams,
        landmark_ids: &[u32],
        streams: &mut RandomStreams,
    ) -> Vec<Detection> {
        let rng = streams.of(RandomStreamPurpose::Clutter);
        let count = deviate::poisson(self.mean, rng);
        (0..count)
            .map(|_| {
                let range = deviate::uniform(params.min_range_m, params.max_range_m, rng);
                let bearing = deviate::uniform(-params.half_view(), params.half_view(), rng);
                let idx = deviate::below(landmark_ids.len(), rng);
                Detection { target: self.label.target(landmark_ids.get(idx)), range, bearing }
            })
            .collect()
    }
}

impl ClutterIdentity {
    fn target(self, any_landmark: Option<&u32>) -> DetectionTarget {
        match (self, any_landmark) {
            (Self::AnyLandmark, Some(id)) => DetectionTarget::Landmark(*id),
            (Self::UnknownCode(code), _) => DetectionTarget::UnknownCode(code),
            (Self::Unlabelled | Self::AnyLandmark, _) => DetectionTarget::Unlabelled,
        }
    }
}
