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
    /// Probability with which correct pairings pass, individually and jointly: chi-squared quantiles with their degrees of freedom.
    pub gate_probability: f64,
    /// NIS above which an observation is certainly of no landmark in the map. In between it is ignored. Default 40: a chi-squared variable of two degrees of freedom
    /// exceeds it with a probability of 2e-9.
    pub new_landmark_nis: f64,
    /// Minimum difference between the NIS of a pairing and those of all other candidates of the observation; otherwise the observation is ambiguous
    /// and ignored. 0 always takes the best. Parallel walls and rows of trees need a larger value.
    pub ambiguity_margin: f64,
    /// Maximum number of pairings tried per scan. When it is reached, the best set so far is used. Unlike a limit in milliseconds, it gives
    /// the same result on every machine. Default 2000.
    pub max_pairings: usize,
    /// Whether the sensor detects each landmark at most once per scan, as with bar codes: a detection beside an associated one then belongs to
    /// another landmark. `false` for detectors that may split a trunk in two.
    pub one_detection_per_landmark: bool,
}

impl Default for JointCompatibilityParams {
    fn default() -> Self {
        Self {
            gate_probability: 0.999,
            new_landmark_nis: 40.0,
            ambiguity_margin: 0.0,
            max_pairings: 2000,
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
/// An unpaired observation starts a landmark if its NIS to every landmark exceeds `new_landmark_nis`, as with
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
    /// Returns [`SlamError::Parameter`] if a parameter is out of range.
    pub fn new(params: JointCompatibilityParams) -> Result<Self, SlamError> {
        let JointCompatibilityParams { gate_probability: probability, new_landmark_nis, .. } = params;
        let Ok(first) = ChiSquaredGate::from_probability(1, probability) else {
            let range = "between 0 and 1, exclusive";
            return Err(SlamError::Parameter { name: "gate_probability", value: probability, range });
        };
        if params.ambiguity_margin.is_nan() || params.ambiguity_margin < 0.0 {
            let (name, value) = ("ambiguity_margin", params.ambiguity_margin);
            return Err(SlamError::Parameter { name, value, range: "not negative" });
        }
        if new_landmark_nis.is_nan() || new_landmark_nis < first.threshold() {
            let range = "at least the gate";
            return Err(SlamError::Parameter { name: "new_landmark_nis", value: new_landmark_nis, range });
        }
        Ok(Self { params, gates: vec![first.threshold()], ids: NewIds::default(), n_cut_short: 0 })
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

    /// Number of scans in which the trials were used up before the search was complete.
    pub fn n_cut_short(&self) -> usize {
        self.n_cut_short
    }

    /// Computes the quantiles up to `dimension` degrees of freedom.
    fn prepare_gates(&mut self, dimension: usize) {
        for degrees in self.gates.len() + 1..=dimension {
            let gate = ChiSquaredGate::from_probability(degrees, self.params.gate_probability);
            // The quantile grows with the degrees of freedom. If its computation fails, the last one is used; it is stricter.
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
        let candidates = Candidates::within(self.params.new_landmark_nis, filter, observations);
        let gate = self.gates.get(size.wrapping_sub(1)).copied().unwrap_or(0.0);
        let mut search = Search::new(filter, &candidates, &self.gates, gate, self.params.max_pairings);
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

/// Whether a landmark not taken by another observation fits almost as well.
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
