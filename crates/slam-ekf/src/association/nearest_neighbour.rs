use nalgebra::DefaultAllocator;

use super::{
    Association, DataAssociation, NewIds,
    candidates::{Candidate, Candidates},
};
use crate::{
    EkfSlam, LandmarkDim, LandmarkModel, MeasurementDim, Observation, RobotDim, SlamAlloc, SlamError,
};

/// Thresholds of [`NearestNeighbour`].
#[derive(Clone, Copy, Debug, PartialEq)]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
#[cfg_attr(
    feature = "serde",
    derive(serde::Serialize, serde::Deserialize),
    serde(default, deny_unknown_fields)
)]
pub struct NearestNeighbourParams {
    /// NIS up to which an observation is associated with its nearest landmark. 13.8 is the 0.999 quantile for range and bearing.
    pub gate_nis: f64,
    /// NIS above which it is certainly of none. In between it is ignored: it neither corrects nor becomes a landmark. Default 40: a chi-squared variable of two degrees
    /// of freedom exceeds it with a probability of 2e-9.
    pub new_landmark_nis: f64,
    /// Whether the sensor detects each landmark at most once per scan, as with bar codes: a detection beside an associated one then belongs to
    /// another landmark. `false` for detectors that may split a trunk in two.
    pub one_detection_per_landmark: bool,
}

impl Default for NearestNeighbourParams {
    fn default() -> Self {
        Self { gate_nis: 13.8155, new_landmark_nis: 40.0, one_detection_per_landmark: false }
    }
}

/// Individual-compatibility nearest neighbour with two thresholds, for sensors that read no identity.
///
/// An observation belongs to the landmark of smallest NIS if that is at most `gate_nis`; it starts a new landmark if even the nearest
/// is further than `new_landmark_nis`. Nothing in between becomes a landmark, which keeps duplicates out of the map.
/// Each landmark takes at most one observation per scan. [Dissanayake et al. 2001, section V]
#[derive(Clone, Debug)]
pub struct NearestNeighbour {
    params: NearestNeighbourParams,
    ids: NewIds,
}

impl NearestNeighbour {
    /// A rule that numbers new landmarks from 0.
    ///
    /// # Errors
    /// Returns [`SlamError::Parameter`] if the thresholds are not positive and ordered.
    pub fn new(params: NearestNeighbourParams) -> Result<Self, SlamError> {
        let NearestNeighbourParams { gate_nis: accept, new_landmark_nis, .. } = params;
        if !(accept > 0.0 && accept.is_finite()) {
            return Err(SlamError::Parameter { name: "gate_nis", value: accept, range: "positive" });
        }
        if new_landmark_nis.is_nan() || new_landmark_nis < accept {
            return Err(SlamError::Parameter {
                name: "new_landmark_nis",
                value: new_landmark_nis,
                range: "at least accept",
            });
        }
        Ok(Self { params, ids: NewIds::default() })
    }

    /// The same rule with new landmark numbers from `next_id` on; it continues another rule.
    pub fn numbering_from(self, next_id: u32) -> Self {
        Self { ids: NewIds::from(next_id), ..self }
    }

    /// The smallest number that a new landmark can get. Save it with the map: numbers of removed landmarks are not used again, and the map
    /// does not contain them.
    pub fn next_id(&self) -> u32 {
        self.ids.next()
    }
}

impl<M: LandmarkModel> DataAssociation<M> for NearestNeighbour
where
    DefaultAllocator: SlamAlloc<RobotDim<M>, LandmarkDim<M>, MeasurementDim<M>>,
{
    fn associate(
        &mut self,
        filter: &EkfSlam<M>,
        observations: &[Observation<M::Measurement>],
    ) -> Vec<Association> {
        let candidates = Candidates::within(self.params.new_landmark_nis, filter, observations);
        let nearest: Vec<Option<(usize, f64)>> = candidates
            .of_observation
            .iter()
            .map(|of_one| nearest_within(self.params.gate_nis, of_one))
            .collect();
        let keeps_its_own = |(own, candidate): (usize, &Option<(usize, f64)>)| {
            let (prediction, nis) = (*candidate)?;
            let is_taken = nearest
                .iter()
                .enumerate()
                .any(|(other, rival)| is_closer(*rival, other, prediction, (nis, own)));
            (!is_taken).then_some(prediction)
        };
        let pairings: Vec<Option<usize>> = nearest.iter().enumerate().map(keeps_its_own).collect();
        candidates.settle(&pairings, self.params.one_detection_per_landmark, || self.ids.next_free(filter))
    }
}

/// The nearest candidate of an observation, if it is near enough, and its NIS.
fn nearest_within<M: LandmarkModel>(accept: f64, of_one: &[Candidate<M>]) -> Option<(usize, f64)>
where
    DefaultAllocator: SlamAlloc<RobotDim<M>, LandmarkDim<M>, MeasurementDim<M>>,
{
    let nearest = of_one.first().filter(|candidate| candidate.innovation.nis <= accept)?;
    Some((nearest.prediction, nearest.innovation.nis))
}

/// Whether another observation is nearer to the same landmark; the earlier one wins a tie.
fn is_closer(
    rival: Option<(usize, f64)>,
    rival_idx: usize,
    prediction: usize,
    (nis, own_idx): (f64, usize),
) -> bool {
    rival.is_some_and(|(of_rival, rival_nis)| {
        of_rival == prediction && (rival_nis, rival_idx) < (nis, own_idx)
    })
}
