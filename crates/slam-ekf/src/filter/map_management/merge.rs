use nalgebra::{DMatrix, DVector, DefaultAllocator, DimName};
use wayfix_estimation_traits::{Manifold, Tangent};

use super::super::{EkfSlam, state::Slot};
use crate::{
    LandmarkDim, LandmarkId, LandmarkMerge, LandmarkModel, MeasurementDim, RobotDim, SlamAlloc, SlamError,
    covariance::SparseJacobian,
};

/// Condition for merging two landmarks of the map: they are certainly nearer to each other than the minimum separation.
///
/// $`‖d‖ + k \sqrt{\operatorname{tr} P_d} ≤ s`$ with $`d = m_b ⊟ m_a`$ and $`P_d`$ its covariance. A test of $`d = 0`$ alone would merge uncertain
/// neighbours, and keep duplicates that time-correlated errors separate.
#[derive(Clone, Copy, Debug, PartialEq)]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
#[cfg_attr(
    feature = "serde",
    derive(serde::Serialize, serde::Deserialize),
    serde(default, deny_unknown_fields)
)]
pub struct LandmarkMergingParams {
    /// Minimum distance between two distinct landmarks, in units of the landmark's tangent space (m for points).
    pub min_separation: f64,
    /// Number of standard deviations of their difference that must also lie within that distance.
    pub n_sigmas: f64,
}

impl Default for LandmarkMergingParams {
    /// Points at least 0.1 m apart, with two standard deviations.
    fn default() -> Self {
        Self { min_separation: 0.1, n_sigmas: 2.0 }
    }
}

impl LandmarkMergingParams {
    pub(in crate::filter) fn validated(self) -> Result<Self, SlamError> {
        for (name, value) in [("min_separation", self.min_separation), ("n_sigmas", self.n_sigmas)] {
            if !(value >= 0.0 && value.is_finite()) {
                return Err(SlamError::Parameter { name, value, range: "finite and not negative" });
            }
        }
        Ok(self)
    }
}

impl<M: LandmarkModel> EkfSlam<M>
where
    DefaultAllocator: SlamAlloc<RobotDim<M>, LandmarkDim<M>, MeasurementDim<M>>,
{
    /// Merges two landmarks: corrects the map with the constraint that their positions are equal, then removes `removed`. Returns `false` and
    /// changes nothing if either is not in the state or their difference has no finite covariance.
    ///
    /// A measurement $`0 = m_{removed} ⊟ m_{kept} + v`$. Time-correlated errors often make the filter's covariance of the
    /// difference too small, so `v` has the size of the difference, $`σ_v^2 = ‖m_{removed} ⊟ m_{kept}‖^2`$: the map is not distorted abruptly.
    ///
    /// ```
    /// use nalgebra::{Matrix2, Vector2};
    /// use wayfix_estimation_traits::Pose2;
    /// use wayfix_slam_ekf::{EkfSlam, LandmarkId, RangeBearingSensor, SlamParams};
    /// let mut slam = EkfSlam::new(RangeBearingSensor::default(), SlamParams::default(), Pose2::new(0.0, 0.0, 0.0))?;
    /// slam.insert(LandmarkId(1), Vector2::new(2.0, 0.0), Matrix2::identity() * 0.01)?;
    /// slam.insert(LandmarkId(2), Vector2::new(2.1, 0.0), Matrix2::identity() * 0.01)?;
    /// assert!(slam.merge(LandmarkId(1), LandmarkId(2)));
    /// // Gain 0.01 / (0.01 + 0.01 + 0.1²) = 1/3.
    /// assert!((slam.landmark(LandmarkId(1)).unwrap().mean.x - (2.0 + 0.1 / 3.0)).abs() < 1e-9);
    /// # Ok::<(), wayfix_slam_ekf::SlamError>(())
    /// ```
    pub fn merge(&mut self, kept: LandmarkId, removed: LandmarkId) -> bool {
        let (Some(kept_slot), Some(gone_slot)) = (self.landmarks.get(&kept), self.landmarks.get(&removed))
        else {
            return false;
        };
        if kept == removed {
            return false;
        }
        let difference = self.mean(kept_slot).local(&self.mean(gone_slot));
        let size = LandmarkDim::<M>::DIM;
        let mut rows = SparseJacobian::default();
        for row in 0..size {
            let unit = |sign: f64| (0..size).map(move |column| if column == row { sign } else { 0.0 });
            rows.push_blocks((kept_slot.offset, unit(-1.0)), (gone_slot.offset, unit(1.0)));
        }
        let softness = difference.norm_squared().max(SMALLEST_SOFTNESS);
        let n_detections = gone_slot.n_detections;
        let noise = DMatrix::from_diagonal_element(size, size, softness);
        let residual = DVector::from_fn(size, |row, _| -difference[row]);
        let Some(step) = self.covariance.correct(&rows, &noise, &residual) else {
            return false;
        };
        self.step(&step);
        self.remove(removed);
        if let Some(slot) = self.landmarks.get_mut(&kept) {
            slot.n_detections += n_detections;
        }
        true
    }

    /// Merges the landmarks observed in this scan with landmarks nearer than the minimum separation.
    pub(in crate::filter) fn merge_duplicates(&mut self) -> Vec<LandmarkMerge> {
        let Some(merging) = self.params.merging else { return Vec::new() };
        let seen: Vec<LandmarkId> = self
            .landmarks
            .iter()
            .filter(|(_, slot)| slot.last_seen == self.n_updates)
            .map(|(id, _)| *id)
            .collect();
        let mut merges = Vec::new();
        for id in seen {
            let Some((kept, removed)) = self.duplicate_of(id, &merging) else { continue };
            if self.merge(kept, removed) {
                merges.push(LandmarkMerge { kept, removed });
            }
        }
        merges
    }

    /// The landmark that is certainly nearer to this one than the minimum separation; the one with more observations first.
    fn duplicate_of(
        &self,
        id: LandmarkId,
        merging: &LandmarkMergingParams,
    ) -> Option<(LandmarkId, LandmarkId)> {
        let own = self.landmarks.get(&id).filter(|slot| self.is_confirmed(slot))?;
        let is_one = |(other_id, other): &(&LandmarkId, &Slot<M::Landmark>)| {
            **other_id != id && self.is_confirmed(other) && self.are_nearer_than(merging, own, other)
        };
        let (other_id, other) = self.landmarks.iter().find(is_one)?;
        let own_is_kept = (own.n_detections, *other_id) > (other.n_detections, id);
        Some(if own_is_kept { (id, *other_id) } else { (*other_id, id) })
    }

    /// The trace bounds the largest variance of the difference in any direction.
    fn are_nearer_than(
        &self,
        merging: &LandmarkMergingParams,
        a: &Slot<M::Landmark>,
        b: &Slot<M::Landmark>,
    ) -> bool {
        let difference: Tangent<M::Landmark> = self.mean(a).local(&self.mean(b));
        let left = merging.min_separation - difference.norm();
        left >= 0.0 && {
            let between = |i| self.covariance.entry(a.offset + i, b.offset + i);
            let cross = (0..LandmarkDim::<M>::DIM).map(between).sum::<f64>();
            let variance = self.landmark_variance(a) + self.landmark_variance(b) - 2.0 * cross;
            merging.n_sigmas * variance.max(0.0).sqrt() <= left
        }
    }
}

/// Variance of the constraint if the two are exactly equal; it keeps the innovation covariance definite.
const SMALLEST_SOFTNESS: f64 = 1e-12;
