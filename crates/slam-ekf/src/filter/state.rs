use std::collections::BTreeMap;

use nalgebra::{DMatrixView, DefaultAllocator, Dim, Matrix3};
use wayfix_estimation_traits::{Manifold, Pose2, TangentMatrix};

use super::{SlamParams, gates::Gates};
use crate::{LandmarkDim, LandmarkId, LandmarkModel, MeasurementDim, SlamAlloc, SlamError, covariance::JointCovariance};

/// EKF-SLAM over one kind of landmark.
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
/// slam.update(&seen(2.0, 0.0), &mut KnownIds)?;                                     // a landmark two metres ahead
/// slam.predict(&IncrementMotion::default(), &Pose2::new(1.1, 0.0, 0.0))?;           // odometry: 1.1 m forward
/// slam.update(&seen(1.0, 0.0), &mut KnownIds)?;                                     // but it is one metre away now
///
/// assert!(slam.robot().x() > 1.0 && slam.robot().x() < 1.1);
/// assert!((slam.landmark(LandmarkId(7)).unwrap().mean.x - 2.0).abs() < 0.1);
/// # Ok::<(), SlamError>(())
/// ```
#[derive(Clone, Debug)]
pub struct EkfSlam<M: LandmarkModel>
where
    DefaultAllocator: SlamAlloc<LandmarkDim<M>, MeasurementDim<M>>,
{
    pub(super) model: M,
    pub(super) gates: Gates,
    pub(super) robot: Pose2<f64>,
    pub(super) landmarks: BTreeMap<LandmarkId, Slot<M::Landmark>>,
    pub(super) anchors: BTreeMap<LandmarkId, M::Landmark>,
    pub(super) covariance: JointCovariance,
}

/// A landmark and where its block starts in the covariance.
#[derive(Clone, Debug)]
pub(super) struct Slot<L> {
    pub(super) mean: L,
    pub(super) offset: usize,
}

/// What is known of one landmark.
#[derive(Clone, Debug, PartialEq)]
pub struct LandmarkEstimate<L: Manifold<Scalar = f64>>
where
    DefaultAllocator: nalgebra::allocator::Allocator<L::Dim, L::Dim>,
{
    /// Its identity.
    pub id: LandmarkId,
    /// Where it is.
    pub mean: L,
    /// How sure that is, marginal over everything else.
    pub covariance: TangentMatrix<L>,
}

impl<M: LandmarkModel> EkfSlam<M>
where
    DefaultAllocator: SlamAlloc<LandmarkDim<M>, MeasurementDim<M>>,
{
    /// An empty map around a robot whose pose is the origin of everything, known exactly.
    ///
    /// # Errors
    /// When a parameter is out of range or the pose is not finite.
    pub fn new(model: M, params: SlamParams, start: Pose2<f64>) -> Result<Self, SlamError> {
        Self::with_start_covariance(model, params, start, Matrix3::zeros())
    }

    /// An empty map around a robot whose pose in a given world is uncertain.
    ///
    /// # Errors
    /// When a parameter is out of range, the pose is not finite, or the covariance is not symmetric positive semidefinite.
    pub fn with_start_covariance(
        model: M,
        params: SlamParams,
        start: Pose2<f64>,
        covariance: Matrix3<f64>,
    ) -> Result<Self, SlamError> {
        if !start.is_finite() {
            return Err(SlamError::NotFinite { what: "start pose" });
        }
        super::predict::check_covariance("start covariance", &covariance)?;
        Ok(Self {
            model,
            gates: Gates::from_probability(params.validated()?.gate_probability),
            robot: start,
            landmarks: BTreeMap::new(),
            anchors: BTreeMap::new(),
            covariance: JointCovariance::from_robot(&covariance),
        })
    }

    /// The estimated pose.
    pub fn robot(&self) -> &Pose2<f64> {
        &self.robot
    }
    /// Covariance of the pose in the body frame, `(x, y, θ)`.
    pub fn robot_covariance(&self) -> Matrix3<f64> {
        self.covariance.robot()
    }
    /// The joint covariance: robot first, then the landmarks in the order in which they came.
    pub fn covariance(&self) -> DMatrixView<'_, f64> {
        self.covariance.matrix()
    }
    /// How many landmarks are in the state; anchors are not.
    pub fn n_landmarks(&self) -> usize {
        self.landmarks.len()
    }
    /// Whether a landmark or an anchor with this identity is in the map.
    pub fn knows(&self, id: LandmarkId) -> bool {
        self.landmarks.contains_key(&id) || self.anchors.contains_key(&id)
    }
    /// The landmark model.
    pub fn model(&self) -> &M {
        &self.model
    }
    /// One landmark of the state.
    pub fn landmark(&self, id: LandmarkId) -> Option<LandmarkEstimate<M::Landmark>> {
        self.landmarks.get(&id).map(|slot| self.estimate(id, slot))
    }
    /// All landmarks of the state in the order of their identities.
    pub fn landmarks(&self) -> impl Iterator<Item = LandmarkEstimate<M::Landmark>> {
        self.landmarks.iter().map(|(id, slot)| self.estimate(*id, slot))
    }
    /// The anchors in the order of their identities.
    pub fn anchors(&self) -> impl Iterator<Item = (LandmarkId, &M::Landmark)> {
        self.anchors.iter().map(|(id, landmark)| (*id, landmark))
    }

    fn estimate(&self, id: LandmarkId, slot: &Slot<M::Landmark>) -> LandmarkEstimate<M::Landmark> {
        LandmarkEstimate { id, mean: slot.mean.clone(), covariance: self.landmark_covariance(slot) }
    }

    pub(super) fn landmark_covariance(&self, slot: &Slot<M::Landmark>) -> TangentMatrix<M::Landmark> {
        let dim = slot.mean.dim();
        let block = slot.offset..slot.offset + dim.value();
        let view = self.covariance.block(block.clone(), block);
        TangentMatrix::<M::Landmark>::from_fn_generic(dim, dim, |row, column| view[(row, column)])
    }
}
