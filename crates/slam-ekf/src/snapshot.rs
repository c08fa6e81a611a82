use crate::LandmarkId;

/// All that a filter knows, as a plain value: what a robot saves to go on after a power cut.
///
/// [`EkfSlam::snapshot`](crate::EkfSlam::snapshot) takes it, [`EkfSlam::resume`](crate::EkfSlam::resume) goes on from it. With the feature `serde` it can be
/// stored in any format that keeps the bits of an `f64`. Model and parameters are not in it: they are the robot's, not the map's.
#[derive(Clone, Debug, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize), serde(deny_unknown_fields))]
pub struct Snapshot<R, L> {
    /// How many looks there were.
    pub n_updates: usize,
    /// The robot's mean.
    pub robot: R,
    /// The landmarks of the state, in the order of their blocks in the covariance.
    pub landmarks: Vec<SavedLandmark<L>>,
    /// Landmarks whose place is known exactly.
    pub anchors: Vec<(LandmarkId, L)>,
    /// Landmarks that left the state and still correct it.
    pub retired: Vec<SavedRetired<L>>,
    /// The joint covariance, robot first: its lower triangle, column by column, $`n (n + 1) / 2`$ numbers. Half a matrix cannot be asymmetric.
    pub covariance: Vec<f64>,
}

/// A landmark of a [`Snapshot`].
#[derive(Clone, Copy, Debug, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize), serde(deny_unknown_fields))]
pub struct SavedLandmark<L> {
    /// Its identity.
    pub id: LandmarkId,
    /// Where it is.
    pub mean: L,
    /// Where it was when it was placed first, which is where a first-estimates filter linearizes.
    pub first: L,
    /// Looks in which it was seen.
    pub n_detections: usize,
    /// Looks that should have shown it and did not.
    pub n_missed: usize,
    /// Of these, since it was seen last.
    pub n_missed_in_a_row: usize,
    /// The look in which it was seen last.
    pub last_seen: usize,
}

/// A landmark of a [`Snapshot`] that left the state.
#[derive(Clone, Debug, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize), serde(deny_unknown_fields))]
pub struct SavedRetired<L> {
    /// Its identity.
    pub id: LandmarkId,
    /// Where it is.
    pub mean: L,
    /// Its marginal when it left, column by column.
    pub covariance: Vec<f64>,
}
