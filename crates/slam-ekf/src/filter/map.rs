use nalgebra::{DefaultAllocator, DimName, allocator::Allocator, linalg::Cholesky};
use wayfix_estimation_traits::{Jacobian, Manifold, TangentMatrix};

use super::{
    EkfSlam,
    predict::{LARGEST_VARIANCE, check_covariance, not_positive_definite},
    state::{Slot, is_finite},
    update_robot::dynamic,
};
use crate::{
    LandmarkDim, LandmarkId, LandmarkModel, MeasurementDim, NewLandmark, RobotDim, SlamAlloc, SlamError,
};

impl<M: LandmarkModel> EkfSlam<M>
where
    DefaultAllocator: SlamAlloc<RobotDim<M>, LandmarkDim<M>, MeasurementDim<M>>,
{
    /// Inserts a landmark with a prior position and its covariance.
    ///
    /// # Errors
    /// Returns an error if the identity is taken, the landmark is not finite or the covariance is not symmetric positive definite.
    pub fn insert(
        &mut self,
        id: LandmarkId,
        landmark: M::Landmark,
        covariance: TangentMatrix<M::Landmark>,
    ) -> Result<(), SlamError> {
        let robot_jacobian = Jacobian::<M::Landmark, M::Robot>::zeros();
        let known = NewLandmark { landmark, robot_jacobian, covariance };
        self.check_free(id)?;
        self.check_start(&known)?;
        self.append(id, known, self.params.confirmation.min_detections);
        Ok(())
    }

    /// Inserts an anchor: a landmark whose position in the world is known exactly.
    ///
    /// An anchor never enters the state; its observations correct robot and map, and tie both to the world. One anchor with
    /// range and bearing fixes a planar map except for the rotation about it; two make it fully observable. [Andrade-Cetto 2005,
    /// Eqs. 20-25; the paper does not mention the rotation]
    ///
    /// # Errors
    /// Returns an error if the identity is taken or the landmark is not finite.
    pub fn add_anchor(&mut self, id: LandmarkId, landmark: M::Landmark) -> Result<(), SlamError> {
        self.check_free(id)?;
        check_finite(&landmark)?;
        self.anchors.insert(id, landmark);
        Ok(())
    }

    /// Removes a landmark or an anchor; the rest of the map keeps its information. Returns `false` if it is not in the map.
    pub fn remove(&mut self, id: LandmarkId) -> bool {
        let Some(removed) = self.landmarks.remove(&id) else {
            return self.anchors.remove(&id).is_some() || self.retired.remove(&id).is_some();
        };
        let size = LandmarkDim::<M>::DIM;
        self.covariance.remove(removed.offset..removed.offset + size);
        for slot in self.landmarks.values_mut().filter(|slot| slot.offset > removed.offset) {
            slot.offset -= size;
        }
        true
    }

    /// Starts a landmark from one measurement, in place of a tentative one with the same identity. On an error that one is unchanged.
    pub(super) fn start(&mut self, id: LandmarkId, measurement: &M::Measurement) -> Result<(), SlamError> {
        let new = self.model.initialize(&self.robot, measurement);
        self.check_start(&new)?;
        if self.is_tentative(id) {
            self.remove(id);
        }
        self.check_free(id)?;
        self.append(id, new, 1);
        Ok(())
    }

    fn append(&mut self, id: LandmarkId, new: NewLandmark<M::Landmark, M::Robot>, n_detections: usize) {
        let offset = self.covariance.append(&new.robot_jacobian, &new.covariance);
        let (mean, first) = (new.landmark.clone(), new.landmark);
        let last_seen = self.n_updates;
        let slot = Slot { mean, first, offset, n_detections, n_missed: 0, n_missed_in_a_row: 0, last_seen };
        self.landmarks.insert(id, slot);
    }

    pub(super) fn check_free(&self, id: LandmarkId) -> Result<(), SlamError> {
        if self.contains(id) { Err(SlamError::LandmarkExists(id)) } else { Ok(()) }
    }

    /// A new landmark may be very uncertain, but it must be finite and its covariance valid.
    fn check_start(&self, new: &NewLandmark<M::Landmark, M::Robot>) -> Result<(), SlamError> {
        let NewLandmark { landmark, robot_jacobian, covariance } = new;
        check_finite(landmark)?;
        let what = "landmark covariance";
        check_covariance(what, covariance)?;
        if Cholesky::new(covariance.clone()).is_none() {
            return Err(not_positive_definite(what, &dynamic(covariance)));
        }
        let joint = robot_jacobian * self.robot_covariance() * robot_jacobian.transpose() + covariance;
        if !joint.iter().all(|entry| entry.abs() < LARGEST_VARIANCE) {
            return Err(SlamError::NotFinite { what });
        }
        Ok(())
    }
}

pub(super) fn check_finite<L: Manifold<Scalar = f64>>(landmark: &L) -> Result<(), SlamError>
where
    DefaultAllocator: Allocator<L::Dim>,
{
    if is_finite(landmark) { Ok(()) } else { Err(SlamError::NotFinite { what: "landmark" }) }
}
