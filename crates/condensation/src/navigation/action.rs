use rand::{Rng, RngExt};

use crate::discrete::entropy;
use crate::{DiscreteStateSpace, MostProbableState, ShortestPathLengths, ViewLocalizer};

/// How the next action is chosen while the robot is not certain where it is.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize), serde(rename_all = "kebab-case"))]
pub enum ActionSelection {
    /// As if the best state were the true one: nearer to the goal. [Kasprzak & Szynkiewicz, Sec. 2.2 (c)]
    #[default]
    Greedy,
    /// Of the actions that bring the best state nearest to the goal, the one after which the next view is expected to leave the least
    /// entropy over the best `hypotheses` places. At the goal, where none brings it nearer, all are compared.
    Informed {
        /// Number of the best places that are distinguished.
        hypotheses: usize,
    },
}

impl ActionSelection {
    /// The index of the action to take; none when there is no way. At a goal that is doubtful the greedy choice is a random action, since
    /// standing still shows nothing new.
    pub(super) fn choose<S: DiscreteStateSpace, R: Rng + ?Sized>(
        self,
        space: &S,
        routes: &ShortestPathLengths,
        localizer: &ViewLocalizer,
        rng: &mut R,
    ) -> Option<usize> {
        let best = localizer.best();
        let greedy = routes.toward(space, best.state)?;
        let is_there = best.state == routes.goal();
        match self {
            Self::Greedy if is_there => Some(rng.random_range(0..space.actions().len())),
            Self::Greedy => Some(greedy),
            Self::Informed { hypotheses } => {
                let reached = |index: usize| space.step(best.state, space.actions()[index]);
                let nearest = routes.distance(reached(greedy));
                let is_open = |&index: &usize| {
                    if is_there {
                        reached(index) != best.state
                    } else {
                        routes.distance(reached(index)) == nearest
                    }
                };
                let open: Vec<usize> = (0..space.actions().len()).filter(is_open).collect();
                Some(most_informative(space, &open, localizer, hypotheses).unwrap_or(greedy))
            }
        }
    }
}

/// The action of the least expected entropy after the next view, the first of equal ones.
fn most_informative<S: DiscreteStateSpace>(
    space: &S,
    open: &[usize],
    localizer: &ViewLocalizer,
    hypotheses: usize,
) -> Option<usize> {
    let candidates = candidates(localizer.belief(), hypotheses);
    let score = |&index: &usize| {
        let action = space.actions()[index];
        let moved = |c: &MostProbableState| MostProbableState {
            state: space.step(c.state, action),
            confidence: c.confidence,
        };
        let moved: Vec<MostProbableState> = candidates.iter().map(moved).collect();
        (expected_entropy(localizer, &moved), index)
    };
    open.iter().map(score).min_by(|a, b| a.0.total_cmp(&b.0)).map(|(_, index)| index)
}

/// The best places, with their beliefs normalized among themselves.
fn candidates(belief: &[f64], n: usize) -> Vec<MostProbableState> {
    let mut all: Vec<MostProbableState> = belief
        .iter()
        .enumerate()
        .map(|(state, &confidence)| MostProbableState { state, confidence })
        .filter(|c| c.confidence > 0.0)
        .collect();
    all.sort_by(|a, b| b.confidence.total_cmp(&a.confidence).then(a.state.cmp(&b.state)));
    all.truncate(n);
    let sum: f64 = all.iter().map(|c| c.confidence).sum();
    all.iter_mut().for_each(|c| c.confidence /= sum);
    all
}

/// $`\sum_i w_i\, H(p(j \mid \text{the view of } i))`$ over the candidates: each in turn is imagined to be the truth.
fn expected_entropy(localizer: &ViewLocalizer, candidates: &[MostProbableState]) -> f64 {
    let after = |truth: &MostProbableState| {
        let log_weight =
            |c: &MostProbableState| c.confidence.ln() + localizer.confusion(truth.state, c.state);
        let log_weights: Vec<f64> = candidates.iter().map(log_weight).collect();
        let largest = log_weights.iter().copied().fold(f64::NEG_INFINITY, f64::max);
        let mut weights: Vec<f64> = log_weights.iter().map(|l| (l - largest).exp()).collect();
        let sum: f64 = weights.iter().sum();
        weights.iter_mut().for_each(|weight| *weight /= sum);
        truth.confidence * entropy(&weights)
    };
    candidates.iter().map(after).sum()
}
