use nalgebra::{DMatrix, DefaultAllocator, DimName, allocator::Allocator};
use wayfix_estimation_traits::{Manifold, TangentMatrix};
use wayfix_gaussian_core::GaussianError;

use super::{
    EkfSlam, SlamParams,
    map::check_finite,
    map_management::retire::Retired,
    predict::{LARGEST_VARIANCE, check_covariance},
    state::Slot,
};
use crate::{
    LandmarkDim, LandmarkId, LandmarkModel, MeasurementDim, RobotDim, SavedLandmark, SavedRetiredLandmark,
    SlamAlloc, SlamError, SlamSnapshot, covariance::MapCovariance,
};

impl<M: LandmarkModel> EkfSlam<M>
where
    DefaultAllocator: SlamAlloc<RobotDim<M>, LandmarkDim<M>, MeasurementDim<M>>,
{
    /// The complete state of the filter as a plain value. Cost O(n²).
    pub fn snapshot(&self) -> SlamSnapshot<M::Robot, M::Landmark> {
        let mut slots: Vec<(&LandmarkId, &Slot<M::Landmark>)> = self.landmarks.iter().collect();
        slots.sort_unstable_by_key(|(_, slot)| slot.offset);
        let saved = |(id, slot): (&LandmarkId, &Slot<M::Landmark>)| SavedLandmark {
            id: *id,
            mean: self.mean(slot),
            first: slot.first.clone(),
            n_detections: slot.n_detections,
            n_missed: slot.n_missed,
            n_missed_in_a_row: slot.n_missed_in_a_row,
            last_seen: slot.last_seen,
        };
        SlamSnapshot {
            n_updates: self.n_updates,
            robot: self.robot.clone(),
            landmarks: slots.into_iter().map(saved).collect(),
            anchors: self.anchors.iter().map(|(id, landmark)| (*id, landmark.clone())).collect(),
            retired: self.retired.iter().map(|(id, retired)| saved_retired(*id, retired)).collect(),
            covariance: lower(&self.covariance.matrix()),
        }
    }

    /// The filter of a snapshot. With the same model and parameters it continues bit for bit as the original. A compressed map continues
    /// up to rounding only: updates that were deferred at the snapshot are rounded once more.
    ///
    /// The snapshot need not be trusted: all of it is checked. Cost O(n³), once.
    ///
    /// ```
    /// use wayfix_estimation_traits::Pose2;
    /// use wayfix_slam_ekf::*;
    /// let (sensor, params) = (RangeBearingSensor::default(), SlamParams::default());
    /// let mut slam = EkfSlam::new(sensor, params, Pose2::new(0.0, 0.0, 0.0))?;
    /// let seen = [Observation { label: Some(LandmarkId(7)), measurement: RangeBearing::new(2.0, 0.1) }];
    /// slam.update(&seen, &mut KnownIdAssociation)?;
    ///
    /// let mut resumed = EkfSlam::resume(sensor, params, slam.snapshot())?;
    /// slam.predict(&OdometryMotion::default(), &Pose2::new(1.0, 0.0, 0.2))?;
    /// resumed.predict(&OdometryMotion::default(), &Pose2::new(1.0, 0.0, 0.2))?;
    /// assert_eq!(resumed.snapshot(), slam.snapshot());
    ///
    /// let mut halved = slam.snapshot();
    /// halved.covariance.truncate(3);
    /// assert!(matches!(EkfSlam::resume(sensor, params, halved), Err(SlamError::Dimension { expected: 15, got: 3, .. })));
    /// # Ok::<(), SlamError>(())
    /// ```
    ///
    /// # Errors
    /// Returns an error if a parameter is out of range, a number is not finite, a count is invalid, an identity is repeated, or the covariance has another
    /// size or is not positive semidefinite.
    pub fn resume(
        model: M,
        params: SlamParams,
        snapshot: SlamSnapshot<M::Robot, M::Landmark>,
    ) -> Result<Self, SlamError> {
        let SlamSnapshot { n_updates, robot, landmarks, anchors, retired, covariance } = snapshot;
        let mut slam = Self::new(model, params, robot)?;
        check_count("n_updates", n_updates, usize::MAX / 2)?;
        slam.n_updates = n_updates;
        for (id, landmark) in anchors {
            slam.add_anchor(id, landmark)?;
        }
        for saved in retired {
            slam.check_free(saved.id)?;
            check_finite(&saved.mean)?;
            let covariance = marginal::<M::Landmark>(&saved.covariance)?;
            slam.retired.insert(saved.id, Retired { mean: saved.mean, covariance });
        }
        let mut offset = RobotDim::<M>::DIM;
        for saved in landmarks {
            let SavedLandmark { id, mean, first, n_detections, n_missed, n_missed_in_a_row, last_seen } =
                saved;
            slam.check_free(id)?;
            check_finite(&mean)?;
            check_finite(&first)?;
            check_count("last_seen", last_seen, n_updates)?;
            check_count("n_detections", n_detections, usize::MAX / 2)?;
            check_count("n_missed", n_missed, usize::MAX / 2)?;
            check_count("n_missed_in_a_row", n_missed_in_a_row, n_missed)?;
            let slot = Slot { mean, first, offset, n_detections, n_missed, n_missed_in_a_row, last_seen };
            slam.landmarks.insert(id, slot);
            offset += LandmarkDim::<M>::DIM;
        }
        slam.covariance = MapCovariance::from_matrix(
            params.covariance_update,
            RobotDim::<M>::DIM,
            joint_covariance(offset, &covariance)?,
        );
        Ok(slam)
    }
}

fn saved_retired<L: Manifold<Scalar = f64, Dim: DimName>>(
    id: LandmarkId,
    retired: &Retired<L>,
) -> SavedRetiredLandmark<L>
where
    DefaultAllocator: Allocator<L::Dim, L::Dim>,
{
    let Retired { mean, covariance } = retired.clone();
    SavedRetiredLandmark { id, mean, covariance: covariance.iter().copied().collect() }
}

fn marginal<L: Manifold<Scalar = f64, Dim: DimName>>(entries: &[f64]) -> Result<TangentMatrix<L>, SlamError>
where
    DefaultAllocator: Allocator<L::Dim, L::Dim>,
{
    let (what, expected, got) =
        ("covariance of a retired landmark", L::Dim::DIM * L::Dim::DIM, entries.len());
    if expected != got {
        return Err(SlamError::Dimension { what, expected, got });
    }
    let covariance = TangentMatrix::<L>::from_iterator(entries.iter().copied());
    check_covariance(what, &covariance)?;
    if covariance.iter().all(|entry| entry.abs() < LARGEST_VARIANCE) {
        Ok(covariance)
    } else {
        Err(SlamError::NotFinite { what })
    }
}

fn check_count(name: &'static str, count: usize, largest: usize) -> Result<(), SlamError> {
    if count <= largest {
        return Ok(());
    }
    Err(SlamError::Parameter {
        name,
        value: count as f64,
        range: "no scan later than the last one, and countable",
    })
}

fn joint_covariance(dimension: usize, lower: &[f64]) -> Result<DMatrix<f64>, SlamError> {
    let what = "saved covariance";
    let (expected, got) = (dimension.saturating_mul(dimension + 1) / 2, lower.len());
    if expected != got {
        return Err(SlamError::Dimension { what, expected, got });
    }
    if !lower.iter().all(|entry| entry.abs() < LARGEST_VARIANCE) {
        return Err(SlamError::NotFinite { what });
    }
    let joint = from_lower(dimension, lower);
    if let Some(value) = negative_pivot(&joint) {
        return Err(SlamError::NotACovariance { what, value, asymmetry: 0.0 });
    }
    Ok(joint)
}

impl<R, L> SlamSnapshot<R, L> {
    /// Replaces the joint covariance by another, robot first, of which the lower triangle counts.
    pub fn set_covariance(&mut self, joint: &DMatrix<f64>) {
        self.covariance = lower(joint);
    }
}

/// The lower triangle, column by column.
fn lower(covariance: &DMatrix<f64>) -> Vec<f64> {
    let n = covariance.nrows();
    (0..n).flat_map(|column| (column..n).map(move |row| covariance[(row, column)])).collect()
}

fn from_lower(dimension: usize, lower: &[f64]) -> DMatrix<f64> {
    let mut covariance = DMatrix::zeros(dimension, dimension);
    let places = (0..dimension).flat_map(|column| (column..dimension).map(move |row| (row, column)));
    for ((row, column), entry) in places.zip(lower) {
        covariance[(row, column)] = *entry;
        covariance[(column, row)] = *entry;
    }
    covariance
}

/// The negative variance, or the pivot of the correlations that fails, up to the rounding errors of a long run; `None` of a covariance.
fn negative_pivot(covariance: &DMatrix<f64>) -> Option<f64> {
    let smallest_variance = covariance.diagonal().min();
    if smallest_variance < 0.0 {
        return Some(smallest_variance);
    }
    let deviations = covariance.diagonal().map(f64::sqrt);
    let correlations =
        DMatrix::from_fn(covariance.nrows(), covariance.ncols(), |row, column| {
            match covariance[(row, column)] {
                _ if row == column => 1.0 + SLACK,
                0.0 => 0.0,
                entry => entry / deviations[row] / deviations[column],
            }
        });
    match wayfix_gaussian_core::cholesky("correlations", &correlations) {
        Err(GaussianError::NotPositiveDefinite { value, .. }) => Some(value),
        Err(_) => Some(f64::NAN),
        Ok(_) => None,
    }
}

/// Eigenvalues of the correlation matrix above minus this count as zero. The filter's own rounding stays within some thousand ε.
const SLACK: f64 = 1e-9;
