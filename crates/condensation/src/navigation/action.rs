use rand::{Rng, RngExt};

use crate::discrete::entropy;
use crate::{BestState, Localizer, Routes, StateSpace};

/// How the next action is chosen while the robot is not certain where it is.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum ActionChoice {
    /// As if the best state were the true one. [Kasprzak & Szynkiewicz, Sec. 2.2 (c)]
    #[default]
    Greedy,
    /// The one after which the next look is expected to leave the least entropy, over the best `hypotheses` places; once they agree,
    /// as greedy.
    Informed {
        /// How many of the best places are told apart.
        hypotheses: usize,
    },
}

impl ActionChoice {
    /// The index of the action to take. At a goal that is doubtful, the greedy choice is a random action: standing still shows nothing new.
    pub(super) fn choose<S: StateSpace, R: Rng + ?Sized>(
        self,
        space: &S,
        routes: &Routes,
        localizer: &Localizer,
        certain: bool,
        rng: &mut R,
    ) -> Option<usize> {
        let best = localizer.best();
        let greedy = routes.toward(space, best.state)?;
        match self {
            Self::Informed { hypotheses } if !certain => {
                Some(informed(space, routes, localizer, hypotheses).unwrap_or(greedy))
            }
            _ if best.state == routes.goal() => Some(rng.random_range(0..space.actions().len())),
            _ => Some(greedy),
        }
    }
}

/// The action with the least expected entropy after the next look; of equal ones that which is nearest to the goal.
fn informed<S: StateSpace>(
    space: &S,
    routes: &Routes,
    localizer: &Localizer,
    hypotheses: usize,
) -> Option<usize> {
    let candidates = candidates(localizer.belief(), hypotheses);
    if candidates.len() < 2 {
        return None;
    }
    let score = |(index, &action): (usize, &S::Action)| {
        let moved: Vec<BestState> = candidates
            .iter()
            .map(|c| BestState { state: space.step(c.state, action), confidence: c.confidence })
            .collect();
        let distance = routes.distance(moved[0].state).unwrap_or(u32::MAX);
        (expected_entropy(localizer, &moved), distance, index)
    };
    let scores = space.actions().iter().enumerate().map(score);
    scores.min_by(|a, b| a.0.total_cmp(&b.0).then(a.1.cmp(&b.1))).map(|(_, _, index)| index)
}

/// The best places, with their beliefs normalized among themselves.
fn candidates(belief: &[f64], n: usize) -> Vec<BestState> {
    let mut all: Vec<BestState> = belief
        .iter()
        .enumerate()
        .map(|(state, &confidence)| BestState { state, confidence })
        .filter(|c| c.confidence > 0.0)
        .collect();
    all.sort_by(|a, b| b.confidence.total_cmp(&a.confidence).then(a.state.cmp(&b.state)));
    all.truncate(n);
    let sum: f64 = all.iter().map(|c| c.confidence).sum();
    all.iter_mut().for_each(|c| c.confidence /= sum);
    all
}

/// $`\sum_i w_i\, H(p(j \mid \text{the view of } i))`$ over the candidates: each in turn is imagined to be the truth.
fn expected_entropy(localizer: &Localizer, candidates: &[BestState]) -> f64 {
    let after = |truth: &BestState| {
        let log_weight = |c: &BestState| c.confidence.ln() + localizer.confusion(truth.state, c.state);
        let log_weights: Vec<f64> = candidates.iter().map(log_weight).collect();
        let largest = log_weights.iter().copied().fold(f64::NEG_INFINITY, f64::max);
        let mut weights: Vec<f64> = log_weights.iter().map(|l| (l - largest).exp()).collect();
        let sum: f64 = weights.iter().sum();
        weights.iter_mut().for_each(|weight| *weight /= sum);
        truth.confidence * entropy(&weights)
    };
    candidates.iter().map(after).sum()
}
