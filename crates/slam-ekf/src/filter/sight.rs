use nalgebra::{DefaultAllocator, linalg::Cholesky};
use wayfix_estimation_traits::{Jacobian, Manifold, TangentMatrix};

use super::EkfSlam;
use crate::{Innovation, LandmarkDim, LandmarkId, LandmarkModel, MeasurementDim, RobotDim, SlamAlloc};

/// How a landmark of the map should look from here: what associations compare measurements with.
#[derive(Clone, Debug)]
pub struct PredictedSighting<M: LandmarkModel>
where
    DefaultAllocator: SlamAlloc<RobotDim<M>, LandmarkDim<M>, MeasurementDim<M>>,
{
    /// The landmark.
    pub landmark: LandmarkId,
    /// $`h(x_r, m)`$.
    pub expected: M::Measurement,
    /// $`H P H^T`$: how uncertain the expectation is, without the noise of the sensor.
    pub covariance: TangentMatrix<M::Measurement>,
    pub(super) robot_jacobian: Jacobian<M::Measurement, M::Robot>,
    /// Where the landmark's block starts and the derivative by it; `None` for anchors.
    pub(super) landmark_jacobian: Option<Block<Jacobian<M::Measurement, M::Landmark>>>,
}

/// Columns of the observation Jacobian, and where in the state they start.
type Block<J> = (usize, J);

impl<M: LandmarkModel> PredictedSighting<M>
where
    DefaultAllocator: SlamAlloc<RobotDim<M>, LandmarkDim<M>, MeasurementDim<M>>,
{
    /// What a measurement with noise $`R`$ says beyond the expectation; `None` when $`H P H^T + R`$ is not positive definite.
    pub fn innovation(
        &self,
        measurement: &M::Measurement,
        noise: &TangentMatrix<M::Measurement>,
    ) -> Option<Innovation<M::Measurement>> {
        let residual = self.expected.local(measurement);
        let covariance = &self.covariance + noise;
        let nis = residual.dot(&Cholesky::new(covariance.clone())?.solve(&residual));
        nis.is_finite().then_some(Innovation { residual, covariance, nis })
    }
}

impl<M: LandmarkModel> EkfSlam<M>
where
    DefaultAllocator: SlamAlloc<RobotDim<M>, LandmarkDim<M>, MeasurementDim<M>>,
{
    /// How a landmark or an anchor should look from here; `None` when it is not in the map, or cannot be seen from here (the model
    /// gives no finite measurement).
    pub fn predicted_sighting(&self, id: LandmarkId) -> Option<PredictedSighting<M>> {
        if let Some(slot) = self.landmarks.get(&id) {
            self.predict_sighting(id, &self.mean(slot), Some(slot.offset))
        } else {
            self.predict_sighting(id, self.anchors.get(&id)?, None)
        }
    }

    /// How everything in the map should look from here, anchors first.
    pub fn predicted_sightings(&self) -> impl Iterator<Item = PredictedSighting<M>> {
        let anchors = self.anchors.iter().filter_map(|(id, mean)| self.predict_sighting(*id, mean, None));
        let landmarks = self.landmarks.iter();
        anchors.chain(
            landmarks
                .filter_map(|(id, slot)| self.predict_sighting(*id, &self.mean(slot), Some(slot.offset))),
        )
    }

    fn predict_sighting(
        &self,
        landmark: LandmarkId,
        mean: &M::Landmark,
        offset: Option<usize>,
    ) -> Option<PredictedSighting<M>> {
        let expected = self.model.expected(&self.robot, mean);
        let robot_jacobian = self.model.robot_jacobian(&self.robot, mean);
        let landmark_jacobian =
            offset.map(|offset| (offset, self.model.landmark_jacobian(&self.robot, mean)));

        let mut covariance = &robot_jacobian * self.robot_covariance() * robot_jacobian.transpose();
        if let Some((offset, jacobian)) = &landmark_jacobian {
            let (cross, own) = self.covariance.landmark_blocks::<LandmarkDim<M>, RobotDim<M>>(*offset);
            let mixed = jacobian * cross * robot_jacobian.transpose();
            covariance += jacobian * own * jacobian.transpose() + &mixed + mixed.transpose();
        }
        let usable = covariance.iter().all(|entry| entry.is_finite()) && self.model.is_usable(&expected);
        usable.then_some(PredictedSighting {
            landmark,
            expected,
            covariance,
            robot_jacobian,
            landmark_jacobian,
        })
    }
}
