use nalgebra::{DefaultAllocator, Dim, linalg::Cholesky};
use wayfix_estimation_traits::{Jacobian, Manifold, Pose2, TangentMatrix};

use super::EkfSlam;
use crate::{Innovation, LandmarkDim, LandmarkId, LandmarkModel, MeasurementDim, SlamAlloc};

/// How a landmark of the map should look from here: what associations compare measurements with.
#[derive(Clone, Debug)]
pub struct PredictedSighting<M: LandmarkModel>
where
    DefaultAllocator: SlamAlloc<LandmarkDim<M>, MeasurementDim<M>>,
{
    /// The landmark.
    pub landmark: LandmarkId,
    /// $`h(x_r, m)`$.
    pub expected: M::Measurement,
    /// $`S = H P H^T + R`$.
    pub covariance: TangentMatrix<M::Measurement>,
    cholesky: Cholesky<f64, MeasurementDim<M>>,
    pub(super) linearization: Linearization<M>,
}

/// Derivatives and noise of one sighting at the current estimate.
#[derive(Clone, Debug)]
pub(super) struct Linearization<M: LandmarkModel>
where
    DefaultAllocator: SlamAlloc<LandmarkDim<M>, MeasurementDim<M>>,
{
    pub(super) robot: Jacobian<M::Measurement, Pose2<f64>>,
    /// Where the landmark's block starts and the derivative by it; `None` for anchors.
    pub(super) landmark: Option<(usize, Jacobian<M::Measurement, M::Landmark>)>,
    pub(super) noise: TangentMatrix<M::Measurement>,
}

impl<M: LandmarkModel> PredictedSighting<M>
where
    DefaultAllocator: SlamAlloc<LandmarkDim<M>, MeasurementDim<M>>,
{
    /// What a measurement says beyond the expectation.
    pub fn innovation(&self, measurement: &M::Measurement) -> Innovation<M::Measurement> {
        let residual = self.expected.local(measurement);
        let nis = residual.dot(&self.cholesky.solve(&residual));
        Innovation { residual, covariance: self.covariance.clone(), nis }
    }
}

impl<M: LandmarkModel> EkfSlam<M>
where
    DefaultAllocator: SlamAlloc<LandmarkDim<M>, MeasurementDim<M>>,
{
    /// How a landmark or an anchor should look from here; `None` when it is not in the map, or cannot be seen from here (the model
    /// gives no finite measurement).
    pub fn predicted_sighting(&self, id: LandmarkId) -> Option<PredictedSighting<M>> {
        if let Some(slot) = self.landmarks.get(&id) {
            self.predict_sighting(id, &slot.mean, Some(slot.offset))
        } else {
            self.predict_sighting(id, self.anchors.get(&id)?, None)
        }
    }

    /// How everything in the map should look from here, anchors first.
    pub fn predicted_sightings(&self) -> impl Iterator<Item = PredictedSighting<M>> {
        let anchors = self.anchors.iter().filter_map(|(id, mean)| self.predict_sighting(*id, mean, None));
        let landmarks = self.landmarks.iter();
        anchors.chain(landmarks.filter_map(|(id, slot)| self.predict_sighting(*id, &slot.mean, Some(slot.offset))))
    }

    fn predict_sighting(
        &self,
        id: LandmarkId,
        mean: &M::Landmark,
        offset: Option<usize>,
    ) -> Option<PredictedSighting<M>> {
        let expected = self.model.expected(&self.robot, mean);
        let robot = self.model.robot_jacobian(&self.robot, mean);
        let noise = self.model.noise(&expected);
        let landmark = offset.map(|offset| (offset, self.model.landmark_jacobian(&self.robot, mean)));

        let mut covariance = &robot * self.covariance.robot() * robot.transpose() + &noise;
        if let Some((offset, jacobian)) = &landmark {
            let block = *offset..*offset + mean.dim().value();
            let cross = self.covariance.block(block.clone(), 0..3);
            let own = self.covariance.block(block.clone(), block);
            let mixed = jacobian * cross * robot.transpose();
            covariance += jacobian * own * jacobian.transpose() + &mixed + mixed.transpose();
        }
        // Cholesky looks at the lower triangle only, so NaN is asked for in all.
        let finite = covariance.iter().all(|entry| entry.is_finite()) && self.model.is_usable(&expected);
        let cholesky = finite.then(|| Cholesky::new(covariance.clone())).flatten()?;
        let linearization = Linearization { robot, landmark, noise };
        Some(PredictedSighting { landmark: id, expected, covariance, cholesky, linearization })
    }
}
