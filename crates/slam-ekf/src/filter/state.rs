use std::collections::{BTreeMap, BTreeSet};

use nalgebra::{DMatrix, DefaultAllocator, DimName};
use wayfix_estimation_traits::{Manifold, TangentMatrix};

use super::{
    CovarianceUpdate, LinearizationPoint, SlamParams, gates::Gates, map_management::retire::Retired,
};
use crate::{
    LandmarkDim, LandmarkId, LandmarkModel, MeasurementDim, RobotDim, SlamAlloc, SlamError,
    covariance::MapCovariance,
};

/// EKF-SLAM over one kind of landmark. [Andrade-Cetto 2005, Fig. 2]
///
/// The covariance of the robot is in the body frame, `(x, y, θ)`; that of landmarks in their own tangent space.
///
/// ```
/// use wayfix_estimation_traits::Pose2;
/// use wayfix_slam_ekf::*;
///
/// let mut slam = EkfSlam::new(RangeBearingSensor::default(), SlamParams::default(), Pose2::new(0.0, 0.0, 0.0))?;
/// let seen = |range, bearing| [Observation { label: Some(LandmarkId(7)), measurement: RangeBearing::new(range, bearing) }];
///
/// let mut ids = KnownIdAssociation;
///
/// slam.update(&seen(2.0, 0.0), &mut ids)?;                                          // a landmark two metres ahead
/// slam.predict(&OdometryMotion::default(), &Pose2::new(1.1, 0.0, 0.0))?;           // odometry: 1.1 m forward
/// slam.update(&seen(1.0, 0.0), &mut ids)?;                                          // but it is one metre away now
///
/// assert!(slam.robot().x() > 1.0 && slam.robot().x() < 1.1);
/// assert!((slam.landmark(LandmarkId(7)).unwrap().mean.x - 2.0).abs() < 0.1);
/// # Ok::<(), SlamError>(())
/// ```
#[derive(Clone, Debug)]
pub struct EkfSlam<M: LandmarkModel>
where
    DefaultAllocator: SlamAlloc<RobotDim<M>, LandmarkDim<M>, MeasurementDim<M>>,
{
    pub(super) model: M,
    pub(super) params: SlamParams,
    pub(super) gates: Gates,
    pub(super) robot: M::Robot,
    pub(super) landmarks: BTreeMap<LandmarkId, Slot<M::Landmark>>,
    pub(super) anchors: BTreeMap<LandmarkId, M::Landmark>,
    pub(super) retired: BTreeMap<LandmarkId, Retired<M::Landmark>>,
    pub(super) covariance: MapCovariance,
    /// Number of updates.
    pub(super) n_updates: usize,
}

/// A landmark and where its block starts in the covariance.
#[derive(Clone, Debug)]
pub(super) struct Slot<L> {
    pub(super) mean: L,
    /// Its first estimate.
    pub(super) first: L,
    pub(super) offset: usize,
    pub(super) n_detections: usize,
    /// Scans with it in view and no detection.
    pub(super) n_missed: usize,
    /// Of these, those since its last detection.
    pub(super) n_missed_in_a_row: usize,
    /// The update of its last detection.
    pub(super) last_seen: usize,
}

/// The estimate of one landmark.
#[derive(Clone, Debug, PartialEq)]
pub struct LandmarkEstimate<L: Manifold<Scalar = f64>>
where
    DefaultAllocator: nalgebra::allocator::Allocator<L::Dim, L::Dim>,
{
    /// Its identity.
    pub id: LandmarkId,
    /// Estimated position.
    pub mean: L,
    /// Marginal covariance.
    pub covariance: TangentMatrix<L>,
}

impl<M: LandmarkModel> EkfSlam<M>
where
    DefaultAllocator: SlamAlloc<RobotDim<M>, LandmarkDim<M>, MeasurementDim<M>>,
{
    /// An empty map and a robot whose pose is known exactly.
    ///
    /// # Errors
    /// Returns an error if a parameter is out of range, the pose is not finite, or the linearization needs symmetries that the model does not have.
    pub fn new(model: M, params: SlamParams, start: M::Robot) -> Result<Self, SlamError> {
        Self::with_start_covariance(model, params, start, TangentMatrix::<M::Robot>::zeros())
    }

    /// An empty map and a robot whose pose in a given world is uncertain.
    ///
    /// # Errors
    /// Returns the errors of [`new`](Self::new), or if the covariance is not symmetric positive semidefinite.
    pub fn with_start_covariance(
        model: M,
        params: SlamParams,
        start: M::Robot,
        covariance: TangentMatrix<M::Robot>,
    ) -> Result<Self, SlamError> {
        if !is_finite(&start) {
            return Err(SlamError::NotFinite { what: "start pose" });
        }
        super::predict::check_covariance("start covariance", &covariance)?;
        if params.linearization_point != LinearizationPoint::Newest && model.symmetries().is_empty() {
            return Err(SlamError::NoSymmetry);
        }
        if params.linearization_point == LinearizationPoint::Invariant
            && params.covariance_update == CovarianceUpdate::Compressed
        {
            return Err(SlamError::InvariantNeedsFullMap);
        }
        Ok(Self {
            model,
            gates: Gates::from_probability(params.validated()?.gate_probability, MeasurementDim::<M>::DIM)?,
            params,
            robot: start,
            landmarks: BTreeMap::new(),
            anchors: BTreeMap::new(),
            retired: BTreeMap::new(),
            covariance: MapCovariance::from_robot(params.covariance_update, &covariance),
            n_updates: 0,
        })
    }

    /// The estimated state of the robot: pose and further coordinates.
    pub fn robot(&self) -> &M::Robot {
        &self.robot
    }
    /// Covariance of the robot in its tangent space: body frame, `(x, y, θ, …)`.
    pub fn robot_covariance(&self) -> TangentMatrix<M::Robot> {
        self.covariance.robot()
    }
    /// The joint covariance: robot first, then the landmarks in the order of insertion. A copy that includes the deferred updates of a compressed
    /// map.
    pub fn covariance(&self) -> DMatrix<f64> {
        self.covariance.matrix()
    }
    /// Number of confirmed landmarks, without anchors.
    pub fn n_landmarks(&self) -> usize {
        self.landmarks.values().filter(|slot| self.is_confirmed(slot)).count() + self.retired.len()
    }
    /// Number of landmarks in the state that are not confirmed yet.
    pub fn n_tentative(&self) -> usize {
        self.landmarks.len() + self.retired.len() - self.n_landmarks()
    }
    /// Whether a landmark or an anchor with this identity is in the map.
    pub fn contains(&self, id: LandmarkId) -> bool {
        self.landmarks.contains_key(&id) || self.anchors.contains_key(&id) || self.retired.contains_key(&id)
    }
    /// The landmark model.
    pub fn model(&self) -> &M {
        &self.model
    }
    /// The parameters.
    pub fn params(&self) -> &SlamParams {
        &self.params
    }
    /// One landmark, confirmed or not, in the state or retired.
    pub fn landmark(&self, id: LandmarkId) -> Option<LandmarkEstimate<M::Landmark>> {
        let in_state = self.landmarks.get(&id).map(|slot| self.estimate(id, slot));
        in_state.or_else(|| self.retired.get(&id).map(|retired| retired.estimate(id)))
    }
    /// All confirmed landmarks in the order of their identities, retired ones with their last estimate in the state.
    pub fn landmarks(&self) -> impl Iterator<Item = LandmarkEstimate<M::Landmark>> {
        let confirmed = self.landmarks.iter().filter(|(_, slot)| self.is_confirmed(slot)).map(|(id, _)| *id);
        let ids: BTreeSet<LandmarkId> = confirmed.chain(self.retired.keys().copied()).collect();
        ids.into_iter().filter_map(|id| self.landmark(id))
    }
    /// The anchors in the order of their identities.
    pub fn anchors(&self) -> impl Iterator<Item = (LandmarkId, &M::Landmark)> {
        self.anchors.iter().map(|(id, landmark)| (*id, landmark))
    }

    fn estimate(&self, id: LandmarkId, slot: &Slot<M::Landmark>) -> LandmarkEstimate<M::Landmark> {
        LandmarkEstimate { id, mean: self.mean(slot), covariance: self.landmark_covariance(slot) }
    }

    /// The current mean, including the deferred updates of a compressed map.
    pub(super) fn mean(&self, slot: &Slot<M::Landmark>) -> M::Landmark {
        let deferred = self.covariance.deferred_step::<LandmarkDim<M>>(slot.offset);
        deferred.map_or_else(|| slot.mean.clone(), |step| slot.mean.retract(&step))
    }

    /// The estimate of a landmark, and the offset of its block in the covariance; no offset for an anchor.
    pub(crate) fn place(&self, id: LandmarkId) -> Option<(M::Landmark, Option<usize>)> {
        let slot = self.landmarks.get(&id).map(|slot| (self.mean(slot), Some(slot.offset)));
        slot.or_else(|| self.anchors.get(&id).map(|mean| (mean.clone(), None)))
    }

    /// Trace of a landmark's covariance, for which its block need not be gathered.
    pub(super) fn landmark_variance(&self, slot: &Slot<M::Landmark>) -> f64 {
        (slot.offset..slot.offset + LandmarkDim::<M>::DIM)
            .map(|state| self.covariance.entry(state, state))
            .sum()
    }

    pub(super) fn landmark_covariance(&self, slot: &Slot<M::Landmark>) -> TangentMatrix<M::Landmark> {
        self.covariance.landmark_blocks::<LandmarkDim<M>, RobotDim<M>>(slot.offset).1
    }
}

/// Points that are not finite are at no finite distance from themselves.
pub(super) fn is_finite<X: Manifold<Scalar = f64>>(point: &X) -> bool
where
    DefaultAllocator: nalgebra::allocator::Allocator<X::Dim>,
{
    point.local(point).iter().all(|entry| entry.is_finite())
}
