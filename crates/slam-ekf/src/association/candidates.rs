use nalgebra::DefaultAllocator;

use crate::{
    EkfSlam, Innovation, LandmarkDim, LandmarkModel, MeasurementDim, Observation, PredictedSighting,
    RobotDim, SlamAlloc,
};

/// A landmark that an observation may be of.
#[derive(Clone, Debug)]
pub(super) struct Candidate<M: LandmarkModel>
where
    DefaultAllocator: SlamAlloc<RobotDim<M>, LandmarkDim<M>, MeasurementDim<M>>,
{
    /// Which of the predicted sightings.
    pub(super) sighting: usize,
    pub(super) measurement: M::Measurement,
    pub(super) innovation: Innovation<M::Measurement>,
}

/// How everything in the map should look from here, and for every observation what it may be of.
pub(super) struct Candidates<M: LandmarkModel>
where
    DefaultAllocator: SlamAlloc<RobotDim<M>, LandmarkDim<M>, MeasurementDim<M>>,
{
    pub(super) sightings: Vec<PredictedSighting<M>>,
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
        let sightings: Vec<_> = filter.predicted_sightings().collect();
        let of_one = |observation: &Observation<M::Measurement>| {
            let noise = filter.model().association_noise(&observation.measurement);
            let mut candidates: Vec<Candidate<M>> = Vec::new();
            for (sighting, predicted) in sightings.iter().enumerate() {
                if let Some(innovation) = predicted.innovation_within(limit, &observation.measurement, &noise)
                {
                    let measurement = observation.measurement.clone();
                    candidates.push(Candidate { sighting, measurement, innovation });
                }
            }
            candidates.sort_by(|a, b| a.innovation.nis.total_cmp(&b.innovation.nis));
            candidates
        };
        let of_observation = observations.iter().map(of_one).collect();
        Self { sightings, of_observation }
    }
}
