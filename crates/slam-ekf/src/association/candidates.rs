use nalgebra::DefaultAllocator;

use super::Association;
use crate::{
    EkfSlam, Innovation, LandmarkDim, LandmarkId, LandmarkModel, MeasurementDim, Observation,
    PredictedMeasurement, RobotDim, SlamAlloc,
};

/// A candidate landmark for an observation.
#[derive(Clone, Debug)]
pub(super) struct Candidate<M: LandmarkModel>
where
    DefaultAllocator: SlamAlloc<RobotDim<M>, LandmarkDim<M>, MeasurementDim<M>>,
{
    /// Index of the prediction.
    pub(super) prediction: usize,
    pub(super) measurement: M::Measurement,
    pub(super) innovation: Innovation<M::Measurement>,
}

/// The predicted measurements of all landmarks, and the candidates of every observation.
pub(super) struct Candidates<M: LandmarkModel>
where
    DefaultAllocator: SlamAlloc<RobotDim<M>, LandmarkDim<M>, MeasurementDim<M>>,
{
    pub(super) predictions: Vec<PredictedMeasurement<M>>,
    /// The candidates of each observation, nearest first.
    pub(super) of_observation: Vec<Vec<Candidate<M>>>,
}

impl<M: LandmarkModel> Candidates<M>
where
    DefaultAllocator: SlamAlloc<RobotDim<M>, LandmarkDim<M>, MeasurementDim<M>>,
{
    /// All landmarks within a NIS of `limit` of each observation.
    pub(super) fn within(
        limit: f64,
        filter: &EkfSlam<M>,
        observations: &[Observation<M::Measurement>],
    ) -> Self {
        let within_reach: Vec<_> = observations
            .iter()
            .map(|observation| filter.search_region(limit, &observation.measurement))
            .collect();
        let predictions: Vec<_> = filter.predicted_measurements_within(Some(&within_reach)).collect();
        let of_one = |observation: &Observation<M::Measurement>| {
            let noise = filter.model().association_noise(&observation.measurement);
            let mut candidates: Vec<Candidate<M>> = Vec::new();
            for (prediction, predicted) in predictions.iter().enumerate() {
                if !filter.model().is_compatible(&predicted.expected, &observation.measurement) {
                    continue;
                }
                let model = filter.model();
                let noise = model.noise_at_expected(&predicted.expected, &observation.measurement, &noise);
                if let Some(innovation) = predicted.innovation_within(limit, &observation.measurement, &noise)
                {
                    let measurement = observation.measurement.clone();
                    candidates.push(Candidate { prediction, measurement, innovation });
                }
            }
            candidates.sort_by(|a, b| a.innovation.nis.total_cmp(&b.innovation.nis));
            candidates
        };
        let of_observation = observations.iter().map(of_one).collect();
        Self { predictions, of_observation }
    }

    /// The association of every observation, given the prediction that it is paired with: an observation without pairing and candidate is new.
    pub(super) fn settle(
        &self,
        pairings: &[Option<usize>],
        one_detection_per_landmark: bool,
        mut new_id: impl FnMut() -> LandmarkId,
    ) -> Vec<Association> {
        let is_taken = |prediction: usize| one_detection_per_landmark && pairings.contains(&Some(prediction));
        let settle_one = |(of_one, pairing): (&Vec<Candidate<M>>, &Option<usize>)| match *pairing {
            Some(prediction) => Association::Matched(self.predictions[prediction].landmark),
            None if of_one.iter().all(|candidate| is_taken(candidate.prediction)) => {
                Association::New(new_id())
            }
            None => Association::Ambiguous,
        };
        self.of_observation.iter().zip(pairings).map(settle_one).collect()
    }
}
