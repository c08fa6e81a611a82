use crate::LandmarkId;

/// The complete state of a filter as a plain value, to be saved and resumed after a power cut.
///
/// [`EkfSlam::snapshot`](crate::EkfSlam::snapshot) takes it, [`EkfSlam::resume`](crate::EkfSlam::resume) continues from it. With the feature `serde` it can be
/// stored in any format that keeps the bits of an `f64`. It does not contain model and parameters.
#[derive(Clone, Debug, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize), serde(deny_unknown_fields))]
pub struct SlamSnapshot<R, L> {
    /// Number of updates.
    pub n_updates: usize,
    /// The robot's mean.
    pub robot: R,
    /// The landmarks of the state, in the order of their blocks in the covariance.
    pub landmarks: Vec<SavedLandmark<L>>,
    /// Landmarks with an exactly known position.
    pub anchors: Vec<(LandmarkId, L)>,
    /// Landmarks that left the state and still correct it.
    pub retired: Vec<SavedRetiredLandmark<L>>,
    /// The joint covariance, robot first: its lower triangle, column by column, $`n (n + 1) / 2`$ numbers. Half a matrix cannot be asymmetric.
    pub covariance: Vec<f64>,
}

/// A landmark of a [`SlamSnapshot`].
#[derive(Clone, Copy, Debug, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize), serde(deny_unknown_fields))]
pub struct SavedLandmark<L> {
    /// Its identity.
    pub id: LandmarkId,
    /// Its estimated position.
    pub mean: L,
    /// Its first estimate, at which a first-estimates filter linearizes.
    pub first: L,
    /// Number of scans with a detection.
    pub n_detections: usize,
    /// Number of scans with it in view and no detection.
    pub n_missed: usize,
    /// Of these, those since its last detection.
    pub n_missed_in_a_row: usize,
    /// The update of its last detection.
    pub last_seen: usize,
}

/// A landmark of a [`SlamSnapshot`] that left the state.
#[derive(Clone, Debug, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize), serde(deny_unknown_fields))]
pub struct SavedRetiredLandmark<L> {
    /// Its identity.
    pub id: LandmarkId,
    /// Its position.
    pub mean: L,
    /// Its marginal covariance when it was retired, column by column.
    pub covariance: Vec<f64>,
}
