use nalgebra::{DefaultAllocator, linalg::Cholesky};
use wayfix_estimation_traits::{Jacobian, Manifold, TangentMatrix};

use super::{
    EkfSlam, LinearizationPoint, map_management::retire::Retired, search_region::SearchRegion, state::Slot,
};
use crate::{Innovation, LandmarkDim, LandmarkId, LandmarkModel, MeasurementDim, RobotDim, SlamAlloc};

/// The predicted measurement of a landmark, for data association.
#[derive(Clone, Debug)]
pub struct PredictedMeasurement<M: LandmarkModel>
where
    DefaultAllocator: SlamAlloc<RobotDim<M>, LandmarkDim<M>, MeasurementDim<M>>,
{
    /// The landmark.
    pub landmark: LandmarkId,
    /// $`h(x_r, m)`$. [Andrade-Cetto 2005, Eq. 4]
    pub expected: M::Measurement,
    /// $`H P H^T`$: covariance of the prediction, without the noise of the sensor. [Andrade-Cetto 2005, Eq. 8]
    pub covariance: TangentMatrix<M::Measurement>,
    pub(super) robot_jacobian: Jacobian<M::Measurement, M::Robot>,
    /// Start of the landmark's block and the derivative by it; `None` for anchors.
    pub(super) landmark_jacobian: Option<Block<Jacobian<M::Measurement, M::Landmark>>>,
    /// Contribution of a retired landmark's position error to the measurement noise; zero for all others.
    pub(super) landmark_noise: TangentMatrix<M::Measurement>,
}

/// Columns of the observation Jacobian, and where in the state they start.
type Block<J> = (usize, J);

impl<M: LandmarkModel> PredictedMeasurement<M>
where
    DefaultAllocator: SlamAlloc<RobotDim<M>, LandmarkDim<M>, MeasurementDim<M>>,
{
    /// The innovation of a measurement with noise $`R`$; `None` if $`H P H^T + R`$ is not positive definite.
    pub fn innovation(
        &self,
        measurement: &M::Measurement,
        noise: &TangentMatrix<M::Measurement>,
    ) -> Option<Innovation<M::Measurement>> {
        self.innovation_within(f64::INFINITY, measurement, noise)
    }

    /// The innovation, if its NIS is at most `limit`. The noise is that at the expected measurement ([`LandmarkModel::noise_at_expected`]).
    ///
    /// A single coordinate rejects most landmarks at low cost, because $`ν_i^2 / S_{ii} ≤ ν^T S^{-1} ν`$.
    pub(crate) fn innovation_within(
        &self,
        limit: f64,
        measurement: &M::Measurement,
        noise: &TangentMatrix<M::Measurement>,
    ) -> Option<Innovation<M::Measurement>> {
        let residual = self.expected.local(measurement);
        let variance = |row: usize| self.covariance[(row, row)] + noise[(row, row)];
        if (0..residual.len()).any(|row| residual[row] * residual[row] > limit * variance(row)) {
            return None;
        }
        let covariance = &self.covariance + noise;
        let nis = residual.dot(&Cholesky::new(covariance.clone())?.solve(&residual));
        (nis.is_finite() && nis <= limit).then_some(Innovation { residual, covariance, nis })
    }
}

impl<M: LandmarkModel> EkfSlam<M>
where
    DefaultAllocator: SlamAlloc<RobotDim<M>, LandmarkDim<M>, MeasurementDim<M>>,
{
    /// The predicted measurement of a landmark or an anchor; `None` if it is not in the map or cannot be observed from here (the model returns
    /// no finite measurement).
    pub fn predicted_measurement(&self, id: LandmarkId) -> Option<PredictedMeasurement<M>> {
        if let Some(slot) = self.landmarks.get(&id) {
            self.predict_measurement(id, &self.mean(slot), Some(slot))
        } else if let Some(retired) = self.retired.get(&id) {
            self.predict_retired(id, retired)
        } else {
            self.predict_measurement(id, self.anchors.get(&id)?, None)
        }
    }

    /// $`H_a P H_b^T`$: cross-covariance of the predictions of two landmarks, without the noise of the sensor.
    pub(crate) fn predicted_cross_covariance(
        &self,
        a: &PredictedMeasurement<M>,
        b: &PredictedMeasurement<M>,
    ) -> TangentMatrix<M::Measurement> {
        let mut cross = &a.robot_jacobian * self.robot_covariance() * b.robot_jacobian.transpose();
        if let Some((offset, by_landmark)) = &a.landmark_jacobian {
            let with_robot = self.covariance.landmark_blocks::<LandmarkDim<M>, RobotDim<M>>(*offset).0;
            cross += by_landmark * with_robot * b.robot_jacobian.transpose();
        }
        if let Some((offset, by_landmark)) = &b.landmark_jacobian {
            let with_robot = self.covariance.landmark_blocks::<LandmarkDim<M>, RobotDim<M>>(*offset).0;
            cross += &a.robot_jacobian * with_robot.transpose() * by_landmark.transpose();
        }
        if let (Some((at_a, by_a)), Some((at_b, by_b))) = (&a.landmark_jacobian, &b.landmark_jacobian) {
            let between = TangentMatrix::<M::Landmark>::from_fn(|row, column| {
                self.covariance.entry(at_a + row, at_b + column)
            });
            cross += by_a * between * by_b.transpose();
        }
        cross
    }

    /// The predicted measurements of all landmarks, anchors first.
    pub fn predicted_measurements(&self) -> impl Iterator<Item = PredictedMeasurement<M>> {
        self.predicted_measurements_within(None)
    }

    /// The predicted measurements of the landmarks in any of the search regions, anchors first; of all landmarks if there are no regions.
    pub(crate) fn predicted_measurements_within<'a>(
        &'a self,
        reaches: Option<&'a [SearchRegion<M::Landmark>]>,
    ) -> impl Iterator<Item = PredictedMeasurement<M>> + 'a {
        let is_near = move |mean: &M::Landmark, variance: f64| {
            reaches.is_none_or(|reaches| reaches.iter().any(|reach| reach.contains(mean, variance)))
        };
        let anchors = self.anchors.iter().filter(move |(_, mean)| is_near(mean, 0.0));
        let retired = self.retired.iter().filter(move |(_, old)| is_near(&old.mean, old.covariance.trace()));
        let in_state = self.landmarks.iter();
        let in_state =
            in_state.filter(move |(_, slot)| is_near(&self.mean(slot), self.landmark_variance(slot)));
        let anchors = anchors.filter_map(|(id, mean)| self.predict_measurement(*id, mean, None));
        let retired = retired.filter_map(|(id, old)| self.predict_retired(*id, old));
        let in_state =
            in_state.filter_map(|(id, slot)| self.predict_measurement(*id, &self.mean(slot), Some(slot)));
        anchors.chain(retired).chain(in_state)
    }

    fn predict_measurement(
        &self,
        landmark: LandmarkId,
        mean: &M::Landmark,
        slot: Option<&Slot<M::Landmark>>,
    ) -> Option<PredictedMeasurement<M>> {
        let expected = self.model.expected(&self.robot, mean);
        let linearized_at = match (slot, self.params.linearization_point) {
            (Some(slot), LinearizationPoint::FirstEstimates) => &slot.first,
            _ => mean,
        };
        let robot_jacobian = self.model.robot_jacobian(&self.robot, linearized_at);
        let landmark_jacobian =
            slot.map(|slot| (slot.offset, self.model.landmark_jacobian(&self.robot, linearized_at)));

        let mut covariance = &robot_jacobian * self.robot_covariance() * robot_jacobian.transpose();
        if let Some((offset, jacobian)) = &landmark_jacobian {
            let (cross, own) = self.covariance.landmark_blocks::<LandmarkDim<M>, RobotDim<M>>(*offset);
            let mixed = jacobian * cross * robot_jacobian.transpose();
            covariance += jacobian * own * jacobian.transpose() + &mixed + mixed.transpose();
        }
        let usable = covariance.iter().all(|entry| entry.is_finite()) && self.model.is_usable(&expected);
        usable.then_some(PredictedMeasurement {
            landmark,
            expected,
            covariance,
            robot_jacobian,
            landmark_jacobian,
            landmark_noise: TangentMatrix::<M::Measurement>::zeros(),
        })
    }

    /// As for an anchor, plus the marginal covariance with which it left the state.
    fn predict_retired(
        &self,
        id: LandmarkId,
        retired: &Retired<M::Landmark>,
    ) -> Option<PredictedMeasurement<M>> {
        let predicted = self.predict_measurement(id, &retired.mean, None)?;
        let jacobian = self.model.landmark_jacobian(&self.robot, &retired.mean);
        let landmark_noise = &jacobian * &retired.covariance * jacobian.transpose();
        let covariance = &predicted.covariance + &landmark_noise;
        let is_finite = covariance.iter().all(|entry| entry.is_finite());
        is_finite.then_some(PredictedMeasurement { covariance, landmark_noise, ..predicted })
    }
}
