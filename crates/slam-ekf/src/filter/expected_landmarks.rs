use nalgebra::DefaultAllocator;

use super::{EkfSlam, PredictedMeasurement};
use crate::{LandmarkDim, LandmarkId, LandmarkModel, MeasurementDim, RobotDim, SlamAlloc};

/// The landmarks that the next scan should show, with their search bands. [Andrade-Cetto 2005, Fig. 1a]
#[derive(Clone, Debug)]
pub struct ExpectedLandmarks<M: LandmarkModel>
where
    DefaultAllocator: SlamAlloc<RobotDim<M>, LandmarkDim<M>, MeasurementDim<M>>,
{
    model: M,
    predicted: Vec<PredictedMeasurement<M>>,
}

impl<M: LandmarkModel + Clone> EkfSlam<M>
where
    DefaultAllocator: SlamAlloc<RobotDim<M>, LandmarkDim<M>, MeasurementDim<M>>,
{
    /// The confirmed landmarks and anchors within range and field of view.
    pub fn expected_landmarks(&self) -> ExpectedLandmarks<M> {
        let is_expected = |predicted: &PredictedMeasurement<M>| {
            !self.is_tentative(predicted.landmark) && self.model.expects_detection(&predicted.expected)
        };
        let predicted = self.predicted_measurements().filter(is_expected).collect();
        ExpectedLandmarks { model: self.model.clone(), predicted }
    }
}

impl<M: LandmarkModel> ExpectedLandmarks<M>
where
    DefaultAllocator: SlamAlloc<RobotDim<M>, LandmarkDim<M>, MeasurementDim<M>>,
{
    /// Their number.
    pub fn len(&self) -> usize {
        self.predicted.len()
    }
    /// Whether nothing is expected.
    pub fn is_empty(&self) -> bool {
        self.predicted.is_empty()
    }

    /// Their predicted measurements.
    pub fn predicted(&self) -> &[PredictedMeasurement<M>] {
        &self.predicted
    }

    /// The most likely landmark whose search band contains the measurement: a compatible extent, and $`d^2 \le n_σ^2`$.
    pub fn find(&self, measurement: &M::Measurement, n_sigmas: f64) -> Option<LandmarkId> {
        let noise = self.model.noise(measurement);
        let compatible = self
            .predicted
            .iter()
            .filter(|predicted| self.model.is_compatible(&predicted.expected, measurement));
        let within = compatible.filter_map(|predicted| {
            let noise = self.model.noise_at_expected(&predicted.expected, measurement, &noise);
            let innovation = predicted.innovation_within(n_sigmas * n_sigmas, measurement, &noise)?;
            Some((innovation.nis, predicted.landmark))
        });
        within.min_by(|a, b| a.0.total_cmp(&b.0)).map(|(_, landmark)| landmark)
    }
}
