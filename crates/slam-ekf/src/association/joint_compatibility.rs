use std::collections::BTreeSet;

use nalgebra::{DefaultAllocator, DimName};
use wayfix_gaussian_core::ChiSquaredGate;

use super::{
    Association, DataAssociation, NewIds,
    candidates::{Candidate, Candidates},
    joint_search::Search,
};
use crate::{
    EkfSlam, LandmarkDim, LandmarkModel, MeasurementDim, Observation, RobotDim, SlamAlloc, SlamError,
};

/// Thresholds of [`JointCompatibility`].
#[derive(Clone, Copy, Debug, PartialEq)]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
#[cfg_attr(
    feature = "serde",
    derive(serde::Serialize, serde::Deserialize),
    serde(default, deny_unknown_fields)
)]
pub struct JointCompatibilityParams {
    /// Probability with which the right pairings pass, each by itself and all together: chi-squared quantiles with their degrees of freedom.
    pub probability: f64,
    /// NIS above which an observation is certainly of no landmark. In between nothing happens with it.
    pub certainly_new: f64,
    /// By how much the NIS of a pairing must be below that of every other landmark which the observation could be of, or it is ambiguous and
    /// nothing happens with it; 0 takes the best whatever else there is. Parallel walls and hedges of trees ask for more.
    pub ambiguity_margin: f64,
    /// Pairings that one look may try. When they are used up the best set so far counts, and the next look starts afresh; a bound in
    /// pairings, unlike one in milliseconds, gives the same result on every machine.
    pub n_trials: usize,
    /// Whether the sensor never tells of one landmark twice in a look, as with bar codes: what lies beside a sighting that found its landmark is
    /// then of another one. Detectors that break a trunk in two must say no.
    pub one_detection_per_landmark: bool,
}

impl Default for JointCompatibilityParams {
    fn default() -> Self {
        Self {
            probability: 0.999,
            certainly_new: 40.0,
            ambiguity_margin: 0.0,
            n_trials: 2000,
            one_detection_per_landmark: false,
        }
    }
}

/// Joint compatibility branch and bound, for sensors that read no identity.
///
/// Pairings that are each plausible can contradict each other: their innovations are correlated through the robot. This rule finds the
/// largest set of pairings whose *joint* NIS passes, $`ν^T S^{-1} ν ≤ χ^2_{\dim ν}(p)`$, and among the largest the one of smallest NIS. A
/// set grows by one pairing at a time, observations with the fewest candidates first, and must pass at every size. [Neira & Tardós 2001]
///
/// What is left over starts a landmark when it is further than `certainly_new` from everything, as with
/// [`NearestNeighbour`](super::NearestNeighbour).
///
/// ```
/// use wayfix_slam_ekf::{JointCompatibility, JointCompatibilityParams};
/// let rule = JointCompatibility::new(JointCompatibilityParams::default())?;
/// assert_eq!(rule.n_cut_short(), 0);
/// # Ok::<(), wayfix_slam_ekf::SlamError>(())
/// ```
#[derive(Clone, Debug)]
pub struct JointCompatibility {
    params: JointCompatibilityParams,
    /// Quantiles by degrees of freedom, from 1.
    gates: Vec<f64>,
    ids: NewIds,
    n_cut_short: usize,
}

impl JointCompatibility {
    /// A rule that numbers new landmarks from 0.
    ///
    /// # Errors
    /// When the probability is not between 0 and 1, or `certainly_new` is below the gate of one degree of freedom.
    pub fn new(params: JointCompatibilityParams) -> Result<Self, SlamError> {
        let JointCompatibilityParams { probability, certainly_new, .. } = params;
        let Ok(first) = ChiSquaredGate::from_probability(1, probability) else {
            let range = "between 0 and 1, exclusive";
            return Err(SlamError::Parameter { name: "probability", value: probability, range });
        };
        if params.ambiguity_margin.is_nan() || params.ambiguity_margin < 0.0 {
            let (name, value) = ("ambiguity_margin", params.ambiguity_margin);
            return Err(SlamError::Parameter { name, value, range: "not negative" });
        }
        if certainly_new.is_nan() || certainly_new < first.threshold() {
            let range = "at least the gate";
            return Err(SlamError::Parameter { name: "certainly_new", value: certainly_new, range });
        }
        Ok(Self { params, gates: vec![first.threshold()], ids: NewIds::default(), n_cut_short: 0 })
    }

    /// The same rule, numbering new landmarks from here on: a rule that goes on where another one stopped.
    pub fn numbering_from(self, next_id: u32) -> Self {
        Self { ids: NewIds::from(next_id), ..self }
    }

    /// The smallest number that a new landmark can get. Saved with the map: numbers of landmarks that were forgotten are not
    /// used again, and the map alone does not tell them.
    pub fn next_id(&self) -> u32 {
        self.ids.next()
    }

    /// In how many looks the trials were used up before the best set was certain.
    pub fn n_cut_short(&self) -> usize {
        self.n_cut_short
    }

    /// Makes the quantiles up to `dimension` degrees of freedom known.
    fn prepare_gates(&mut self, dimension: usize) {
        for degrees in self.gates.len() + 1..=dimension {
            let gate = ChiSquaredGate::from_probability(degrees, self.params.probability);
            // The quantile grows with the degrees of freedom; where its computation gives up, the last one is stricter.
            let last = self.gates.last().copied().unwrap_or(0.0);
            self.gates.push(gate.map_or(last, |gate| gate.threshold()));
        }
    }
}

impl<M: LandmarkModel> DataAssociation<M> for JointCompatibility
where
    DefaultAllocator: SlamAlloc<RobotDim<M>, LandmarkDim<M>, MeasurementDim<M>>,
{
    fn associate(
        &mut self,
        filter: &EkfSlam<M>,
        observations: &[Observation<M::Measurement>],
    ) -> Vec<Association> {
        let size = MeasurementDim::<M>::DIM;
        self.prepare_gates(size * observations.len());
        let candidates = Candidates::within(self.params.certainly_new, filter, observations);
        let gate = self.gates.get(size.wrapping_sub(1)).copied().unwrap_or(0.0);
        let mut search = Search::new(filter, &candidates, &self.gates, gate, self.params.n_trials);
        search.run();
        self.n_cut_short += usize::from(search.is_cut_short());
        let pairings = search.best;
        let taken: BTreeSet<usize> = pairings.iter().flatten().copied().collect();

        let margin = self.params.ambiguity_margin;
        let is_contested = |(observation, pairing): (usize, &Option<usize>)| {
            margin > 0.0
                && pairing.is_some_and(|prediction| {
                    has_alternative(&candidates.of_observation[observation], prediction, &taken, margin)
                })
        };
        let contested: Vec<bool> = pairings.iter().enumerate().map(is_contested).collect();
        let settled = candidates
            .settle(&pairings, self.params.one_detection_per_landmark, || self.ids.next_free(filter));
        let judge = |(association, contested)| if contested { Association::Ambiguous } else { association };
        settled.into_iter().zip(contested).map(judge).collect()
    }
}

/// Whether a landmark that no other observation takes fits almost as well.
fn has_alternative<M: LandmarkModel>(
    candidates: &[Candidate<M>],
    chosen: usize,
    taken: &BTreeSet<usize>,
    margin: f64,
) -> bool
where
    DefaultAllocator: SlamAlloc<RobotDim<M>, LandmarkDim<M>, MeasurementDim<M>>,
{
    let nis_of = |candidate: &&Candidate<M>| candidate.innovation.nis;
    let own = candidates.iter().find(|candidate| candidate.prediction == chosen).as_ref().map_or(0.0, nis_of);
    let mut others = candidates.iter().filter(|other| !taken.contains(&other.prediction));
    others.any(|other| other.innovation.nis < own + margin)
}
