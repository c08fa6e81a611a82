use nalgebra::{DefaultAllocator, DimName, linalg::Cholesky};
use wayfix_estimation_traits::{Jacobian, TangentMatrix};

use super::{
    EkfSlam,
    state::{Slot, is_finite},
};
use crate::{
    LandmarkDim, LandmarkId, LandmarkModel, MeasurementDim, NewLandmark, RobotDim, SlamAlloc, SlamError,
};

impl<M: LandmarkModel> EkfSlam<M>
where
    DefaultAllocator: SlamAlloc<RobotDim<M>, LandmarkDim<M>, MeasurementDim<M>>,
{
    /// Puts a landmark into the map whose place is known from elsewhere, with the uncertainty it is known with.
    ///
    /// # Errors
    /// When the identity is taken, the landmark is not finite or the covariance is not symmetric positive definite.
    pub fn insert(
        &mut self,
        id: LandmarkId,
        landmark: M::Landmark,
        covariance: TangentMatrix<M::Landmark>,
    ) -> Result<(), SlamError> {
        let robot_jacobian = Jacobian::<M::Landmark, M::Robot>::zeros();
        self.append(
            id,
            NewLandmark { landmark, robot_jacobian, covariance },
            self.params.confirmation.n_sightings,
        )
    }

    /// Puts an anchor into the map: a landmark whose place in the world is known exactly.
    ///
    /// An anchor never enters the state; its observations correct robot and map, and tie both to the world. One anchor with
    /// range and bearing, or two with range, make a planar map fully observable. [Andrade-Cetto 2003, section 2.3]
    ///
    /// # Errors
    /// When the identity is taken or the landmark is not finite.
    pub fn add_anchor(&mut self, id: LandmarkId, landmark: M::Landmark) -> Result<(), SlamError> {
        self.check_new(id, &landmark)?;
        self.anchors.insert(id, landmark);
        Ok(())
    }

    /// Takes a landmark or an anchor out of the map; what it taught about everything else stays. `false` when it is not in the map.
    pub fn remove(&mut self, id: LandmarkId) -> bool {
        let Some(removed) = self.landmarks.remove(&id) else {
            return self.anchors.remove(&id).is_some();
        };
        let size = LandmarkDim::<M>::DIM;
        self.covariance.remove(removed.offset..removed.offset + size);
        for slot in self.landmarks.values_mut().filter(|slot| slot.offset > removed.offset) {
            slot.offset -= size;
        }
        true
    }

    /// Starts a landmark from its first measurement.
    pub(super) fn initialize(
        &mut self,
        id: LandmarkId,
        measurement: &M::Measurement,
    ) -> Result<(), SlamError> {
        self.append(id, self.model.initialize(&self.robot, measurement), 1)
    }

    fn append(
        &mut self,
        id: LandmarkId,
        new: NewLandmark<M::Landmark, M::Robot>,
        n_sightings: usize,
    ) -> Result<(), SlamError> {
        self.check_new(id, &new.landmark)?;
        if !new.robot_jacobian.iter().chain(new.covariance.iter()).all(|entry| entry.is_finite()) {
            return Err(SlamError::NotFinite { what: "new landmark" });
        }
        let asymmetry = (&new.covariance - new.covariance.transpose()).amax();
        let definite = Cholesky::new(new.covariance.clone()).is_some();
        if !definite || asymmetry > 1e-9 * new.covariance.amax() {
            let value = new.covariance.diagonal().min();
            return Err(SlamError::NotACovariance { what: "landmark covariance", value, asymmetry });
        }
        let offset = self.covariance.append(&new.robot_jacobian, &new.covariance);
        self.landmarks.insert(id, Slot { mean: new.landmark, offset, n_sightings, last_seen: self.look });
        Ok(())
    }

    fn check_new(&self, id: LandmarkId, landmark: &M::Landmark) -> Result<(), SlamError> {
        if self.landmarks.contains_key(&id) || self.anchors.contains_key(&id) {
            return Err(SlamError::LandmarkExists(id));
        }
        if !is_finite(landmark) {
            return Err(SlamError::NotFinite { what: "landmark" });
        }
        Ok(())
    }
}
