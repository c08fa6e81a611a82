use std::cmp::Ordering;

use nalgebra::DefaultAllocator;

use super::{Association, DataAssociation, tentative::TentativeLandmarks};
use crate::{
    EkfSlam, LandmarkDim, LandmarkId, LandmarkModel, MeasurementDim, Observation, PredictedSighting, SlamAlloc, SlamError,
};

/// Thresholds of [`NearestNeighbour`].
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct NearestNeighbourParams {
    /// NIS up to which an observation is of its nearest landmark. 13.8 is the 0.999 quantile for range and bearing.
    pub accept: f64,
    /// NIS above which it is certainly of none. In between nothing happens with it: it neither corrects nor becomes a landmark.
    pub certainly_new: f64,
    /// Looks in which a candidate has to be seen before it becomes a landmark.
    pub confirmations: usize,
    /// Looks after which a candidate that was not seen again is forgotten.
    pub patience: usize,
}

impl Default for NearestNeighbourParams {
    fn default() -> Self {
        Self { accept: 13.8155, certainly_new: 40.0, confirmations: 3, patience: 10 }
    }
}

/// Individual-compatibility nearest neighbour with two thresholds, for sensors that read no identity.
///
/// An observation belongs to the landmark of smallest NIS if that is at most `accept`; it is a candidate for a new landmark if even
/// the nearest is further than `certainly_new`; nothing in between becomes a landmark, which is what keeps duplicates out of the map.
/// Each landmark takes at most one observation a look. [Dissanayake et al. 2001, section V]
#[derive(Clone, Debug)]
pub struct NearestNeighbour<M: LandmarkModel>
where
    DefaultAllocator: SlamAlloc<LandmarkDim<M>, MeasurementDim<M>>,
{
    params: NearestNeighbourParams,
    tentative: TentativeLandmarks<M>,
}

impl<M: LandmarkModel> NearestNeighbour<M>
where
    DefaultAllocator: SlamAlloc<LandmarkDim<M>, MeasurementDim<M>>,
{
    /// A rule with no candidates yet.
    ///
    /// # Errors
    /// When the thresholds are not positive and ordered, or no confirmation is asked for.
    pub fn new(params: NearestNeighbourParams) -> Result<Self, SlamError> {
        let NearestNeighbourParams { accept, certainly_new, confirmations, patience } = params;
        if !(accept > 0.0 && accept.is_finite()) {
            return Err(SlamError::Parameter { name: "accept", value: accept, range: "positive" });
        }
        if !(certainly_new >= accept) {
            return Err(SlamError::Parameter { name: "certainly_new", value: certainly_new, range: "at least accept" });
        }
        if confirmations == 0 {
            return Err(SlamError::Parameter { name: "confirmations", value: 0.0, range: "at least 1" });
        }
        Ok(Self { params, tentative: TentativeLandmarks::new(confirmations, patience, accept) })
    }
}

impl<M: LandmarkModel> DataAssociation<M> for NearestNeighbour<M>
where
    DefaultAllocator: SlamAlloc<LandmarkDim<M>, MeasurementDim<M>>,
{
    fn associate(&mut self, filter: &EkfSlam<M>, observations: &[Observation<M::Measurement>]) -> Vec<Association> {
        let sightings: Vec<_> = filter.predicted_sightings().collect();
        let nearest: Vec<_> = observations.iter().map(|seen| nearest_landmark(&sightings, &seen.measurement)).collect();
        self.tentative.begin_look(filter);
        let associate_one = |(i, seen): (usize, &Observation<M::Measurement>)| match nearest[i] {
            Some((id, nis)) if nis <= self.params.accept => {
                if is_taken_by_a_closer_one(&nearest, i, id, nis) { Association::Ambiguous } else { Association::Matched(id) }
            }
            Some((_, nis)) if nis <= self.params.certainly_new => Association::Ambiguous,
            _ => self.tentative.offer(filter, &seen.measurement),
        };
        observations.iter().enumerate().map(associate_one).collect()
    }
}

fn nearest_landmark<M: LandmarkModel>(
    sightings: &[PredictedSighting<M>],
    measurement: &M::Measurement,
) -> Option<(LandmarkId, f64)>
where
    DefaultAllocator: SlamAlloc<LandmarkDim<M>, MeasurementDim<M>>,
{
    sightings
        .iter()
        .map(|sighting| (sighting.landmark, sighting.innovation(measurement).nis))
        .min_by(|(_, a), (_, b)| a.partial_cmp(b).unwrap_or(Ordering::Equal))
}

fn is_taken_by_a_closer_one(nearest: &[Option<(LandmarkId, f64)>], own: usize, id: LandmarkId, nis: f64) -> bool {
    nearest.iter().enumerate().any(|(other, candidate)| {
        other != own && candidate.is_some_and(|(other_id, other_nis)| other_id == id && (other_nis, other) < (nis, own))
    })
}
